// SPDX-License-Identifier: GPL-3.0-or-later
// A replay given up at every moment at which its state may be kept, also before the
// first load of a body with weight, and gone on with: the same response to the bit, by
// cycles and by equilibria, held, on a wall and free, where the load follows the grains
// at some cycles only. And what overshoots on the way to rest breaks nothing.
#include "pulled_pair.h"

#include <math.h>
#include <string.h>

enum {
    SIDE = 3,
    HEIGHT = 4,
    GRAINS = SIDE * SIDE * HEIGHT,
    LOADS = 12,
    MOST = 400,
    EVERY = 17
};

// States in the order in which they were kept.
struct states {
    int count, asked;
    struct kept_state state[MOST];
};

static bool now_and_then(void *context)
{
    struct states *states = context;
    return states->asked++ % EVERY == 0;
}

static struct array_list copied(const struct array_list *list)
{
    struct array_list copy = {NULL, 0};
    for (int k = 0; k < list->count; k++)
        add_array(&copy, list->array[k].name, list->array[k].type, list->array[k].count,
                  list->array[k].data);
    return copy;
}

static void remember(void *context, const struct kept_state *state)
{
    struct states *states = context;
    if (states->count == MOST) return;
    states->state[states->count++] =
        (struct kept_state){copied(&state->engine), copied(&state->stage)};
}

// A body that its weight breaks in part, and then what pulls on it.
struct scene {
    struct packing packing;
    uint8_t held[GRAINS];
    double time[LOADS], saturation[LOADS];
    struct vector weight[GRAINS], force[LOADS * GRAINS];
    struct rows_in_memory rows;
    struct load load;
    struct replay_settings settings;
};

static const double weight = 2e-9; // N, of a grain

static void make(struct scene *scene, enum engine engine, enum support support)
{
    static double strength[3 * GRAINS];
    *scene = (struct scene){.packing = cubic_lattice(SIDE, SIDE, HEIGHT, false)};
    const struct dem_setup setup = stiff_setup(&scene->packing);
    const double pull =
        (support == SUPPORT_FIXED ? 3 : 80) * weight; // what hangs breaks sooner
    for (int i = 0; i < GRAINS; i++) {
        scene->held[i] = support == SUPPORT_FIXED && i / (SIDE * SIDE) == HEIGHT - 1;
        scene->weight[i].z = -weight;
        for (int k = 0; k < LOADS; k++)
            scene->force[k * GRAINS + i] =
                (struct vector){pull * sin(i + k), pull * cos(2 * i - k), -weight};
    }
    for (int b = 0; b < scene->packing.n_bond; b++)
        strength[b] = 1 + 0.9 * sin(b * b);
    for (int k = 0; k < LOADS; k++) {
        scene->time[k] = k;
        scene->saturation[k] = 1 - k / (LOADS - 1.0);
    }
    scene->load = (struct load){.n_time = LOADS,
                                .time = scene->time,
                                .saturation = scene->saturation,
                                .source = &scene->rows,
                                .force = row_in_memory};
    scene->rows = (struct rows_in_memory){scene->force, GRAINS};
    scene->settings = (struct replay_settings){
        .material = setup.material,
        .bond = setup.bond,
        .relative_strength = strength,
        .held = scene->held,
        .unstressed = true,
        .support = support,
        .loose = support == SUPPORT_FIXED ? LOOSE_LOADED : LOOSE_UNLOADED,
        .engine = engine,
        .equilibrium_tolerance = 1e-8,
        .most_iterations = 40,
        .rolling = 1e-3,
        .increment = 0.02,
        .time_step_safety = 0.03,
        .cycles = 60,
        .ramp = 40,
        .tolerance = NAN,
        .threads = 1,
        .weight = support == SUPPORT_FREE ? NULL : scene->weight};
    scene->settings.bond.normal_strength = scene->settings.bond.shear_strength =
        4 * weight / (M_PI * pow(0.5858 * RADIUS, 2));
}

static struct response replayed(const struct scene *scene, const struct keeper *keeper)
{
    struct response response;
    struct reason reason = {""};
    if (replay(&scene->packing, &scene->load, &scene->settings, NULL, keeper, &response,
               &reason))
        fail_msg("%s", reason.text);
    return response;
}

static void assert_same(const struct response *a, const struct response *b, int state)
{
    bool same = a->n_crack == b->n_crack && a->n_weight_crack == b->n_weight_crack &&
                !memcmp(&a->weight_unbalanced_ratio, &b->weight_unbalanced_ratio,
                        sizeof(double)) &&
                a->n_detached == b->n_detached &&
                a->first_detached == b->first_detached;
    for (int k = 0; same && k < a->n_crack; k++)
        same = a->crack[k].bond == b->crack[k].bond &&
               a->crack_step[k] == b->crack_step[k];
    for (int k = 0; same && k < a->n_weight_crack; k++)
        same = a->weight_crack[k].bond == b->weight_crack[k].bond;
    same = same && !memcmp(a->reaction, b->reaction, LOADS * sizeof *a->reaction) &&
           !memcmp(a->cycles, b->cycles, LOADS * sizeof *a->cycles) &&
           !memcmp(a->settled, b->settled, LOADS) &&
           !memcmp(a->unbalanced_ratio, b->unbalanced_ratio, LOADS * sizeof(double));
    if (!same) fail_msg("another end from state %d", state);
}

static void goes_on(enum engine engine, enum support support, int from_weight)
{
    static struct scene scene;
    static struct states states;
    make(&scene, engine, support);
    states.count = states.asked = 0;
    const struct keeper keeper = {now_and_then, remember, &states, NULL};
    struct response whole = replayed(&scene, &keeper);
    print_message("# weight breaks %d, forces %d, loose %d\n", whole.n_weight_crack,
                  whole.n_crack, whole.n_detached);
    if ((support == SUPPORT_FIXED && !whole.n_weight_crack) || !whole.n_crack ||
        (support != SUPPORT_FIXED && !whole.n_detached))
        fail_msg("weight breaks %d, forces %d, %d are loose", whole.n_weight_crack,
                 whole.n_crack, whole.n_detached);
    int before_drying = 0;
    for (int k = 0; k < states.count; k++) {
        const struct array_list *stage = &states.state[k].stage;
        const struct named_array *step = find_array(stage->array, stage->count, "step");
        before_drying += *(const int64_t *)step->data < 0;
        const struct keeper later = {NULL, NULL, NULL, &states.state[k]};
        struct response response = replayed(&scene, &later);
        assert_same(&whole, &response, k);
        response_free(&response);
        free_kept_state(&states.state[k]);
    }
    if (before_drying < from_weight || before_drying == states.count)
        fail_msg("%d of %d states before drying", before_drying, states.count);
    response_free(&whole);
    packing_free(&scene.packing);
}

TEST(cycles_go_on)
{
    goes_on(ENGINE_EXPLICIT, SUPPORT_FIXED, 10);
}

TEST(cycles_go_on_on_a_wall)
{
    goes_on(ENGINE_EXPLICIT, SUPPORT_WALL, 1);
}

TEST(cycles_go_on_where_nothing_is_held)
{
    goes_on(ENGINE_EXPLICIT, SUPPORT_FREE, 0);
}

TEST(equilibria_go_on)
{
    goes_on(ENGINE_QUASI_STATIC, SUPPORT_FIXED, 0);
}

// A pair that hangs: a load that comes at once stretches it to twice what rest does.
TEST(nothing_breaks_on_the_way)
{
    for (int is_weaker = 0; is_weaker < 2; is_weaker++) {
        struct response response =
            pull_pair(weight, is_weaker ? 0.999 : 1.001, 2000, 0, true);
        assert_int_equal(response.n_weight_crack, is_weaker);
        assert_int_equal(response.n_crack, 0);
        response_free(&response);
    }
}
