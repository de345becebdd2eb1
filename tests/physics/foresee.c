// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibria that were found several loads at a time are those found one by one:
// displacements, contacts and cracks, wherever among the loads one comes.
#include "basics/memory.h"
#include "dem_scene.h"
#include "support_equilibrium.h"

enum { SIDE = 4, HIGH = 5, N = SIDE * SIDE * HIGH, LOADS = 27, LAST = LOADS - 1 };

static const double strength = 6e4, jerk_force = 2e-8; // N/m2, N

struct scene {
    struct packing packing;
    uint8_t fixed[N];
    struct equilibrium_setup setup;
    struct vector force[LOADS][N];
};

// Held below, or nowhere; pressed from the sides, more and more from load to load, and
// pulled up, so that contacts open and close; grain 38 pulled harder at the load JERK.
static struct scene *make_scene(double pull, int jerk, bool is_free)
{
    struct scene *s = NEW_ARRAY(struct scene, 1);
    s->packing = cubic_lattice(SIDE, SIDE, HIGH, false);
    for (int i = 0; i < N && !is_free; i++)
        s->fixed[i] = i < SIDE * SIDE;
    s->setup = (struct equilibrium_setup){
        .packing = &s->packing,
        .fixed = s->fixed,
        .is_free = is_free,
        .material = {.normal_stiffness = 3e4, .shear_stiffness = 3e4},
        .bond = {.normal_stiffness = 8e14,
                 .shear_stiffness = 8e14,
                 .normal_strength = strength,
                 .shear_strength = strength,
                 .radius_fraction = 0.5858},
        .tolerance = 1e-8,
        .most_iterations = 40};
    for (int k = 0; k < LOADS; k++)
        for (int i = 0; i < N; i++) {
            const double x = i % SIDE - 1.5, y = i / SIDE % SIDE - 1.5;
            const double more = sin(0.3 * k + i), size = 1e-10 * (1 + 0.2 * k);
            s->force[k][i] = (struct vector){size * (more - x), size * (0.5 - more * y),
                                             size * pull * more};
        }
    if (jerk >= 0) s->force[jerk][38].z += jerk_force;
    return s;
}

static void free_scene(struct scene *s)
{
    packing_free(&s->packing);
    free(s);
}

struct outcome {
    struct vector moved[LOADS][N];
    int touching[LOADS], cracks[LOADS];
    int32_t bond[4 * N];
    bool is_gone[N]; // in the end
};

// The first KNOWN loads are known beforehand.
static struct outcome *find_all(const struct scene *s, int known)
{
    struct outcome *outcome = NEW_ARRAY(struct outcome, 1);
    struct equilibrium *equilibrium = make_equilibrium(&s->setup);
    equilibrium_expect(equilibrium, known, s->force[0]);
    for (int k = 0; k < LOADS; k++) {
        next_equilibrium(equilibrium, s->force[k]);
        equilibrium_displacements(equilibrium, outcome->moved[k]);
        free(equilibrium_contacts(equilibrium, &outcome->touching[k]));
        const struct dem_crack *crack =
            equilibrium_cracks(equilibrium, &outcome->cracks[k]);
        for (int c = 0; c < outcome->cracks[k]; c++)
            outcome->bond[c] = crack[c].bond;
    }
    memcpy(outcome->is_gone, equilibrium_is_gone(equilibrium), sizeof outcome->is_gone);
    equilibrium_free(equilibrium);
    return outcome;
}

// How far grain I lies apart; where nothing holds the aggregate, as rounding may move
// and turn all as one, by how much the rows that begin at it are longer.
static double apart(const struct scene *s, const struct vector *one,
                    const struct vector *other, int i)
{
    const struct vector here = subtract(one[i], other[i]);
    if (!s->setup.is_free) return norm(here);
    const bool has_next[3] = {i % SIDE < SIDE - 1, i / SIDE % SIDE < SIDE - 1,
                              i / SIDE / SIDE < HIGH - 1};
    const int next[3] = {i + 1, i + SIDE, i + SIDE * SIDE};
    double most = 0;
    for (int k = 0; k < 3; k++)
        if (has_next[k]) {
            const struct vector there = subtract(one[next[k]], other[next[k]]);
            const struct vector longer = subtract(there, here);
            most = fmax(most, fabs((&longer.x)[k]));
        }
    return most;
}

// Once none of the loads are known, once KNOWN. How many cracks there are.
static int compare(const struct scene *s, int known)
{
    struct outcome *one = find_all(s, 0), *more = find_all(s, known);
    double size = 0;
    for (int k = 0; k < LOADS; k++)
        for (int i = 0; i < N; i++)
            if (!one->is_gone[i]) size = fmax(size, norm(one->moved[k][i]));
    for (int k = 0; k < LOADS; k++) {
        assert_int_equal(more->cracks[k], one->cracks[k]);
        assert_int_equal(more->touching[k], one->touching[k]);
        for (int i = 0; i < N; i++)
            if (!one->is_gone[i])
                assert_true(apart(s, one->moved[k], more->moved[k], i) <= 1e-8 * size);
    }
    const int cracks = one->cracks[LAST];
    assert_memory_equal(one->bond, more->bond, sizeof one->bond);
    assert_memory_equal(one->is_gone, more->is_gone, sizeof one->is_gone);
    free(one);
    free(more);
    return cracks;
}

static void contacts_open_and_close(void **state)
{
    (void)state;
    struct scene *s = make_scene(3, -1, false);
    s->setup.bond.normal_strength = s->setup.bond.shear_strength = INFINITY;
    assert_int_equal(compare(s, LOADS), 0);
    assert_int_equal(compare(s, 5), 0);
    free_scene(s);
}

// Between events loads lie on lines: from events of uneven distance on, and all the
// same after the last. The shares are not those that numbers hold exactly.
static void loads_lie_on_lines(void **state)
{
    (void)state;
    const int event[] = {0, 1, 2, 14, 15, 19, 22, LAST};
    struct scene *s = make_scene(3, -1, false);
    s->setup.bond.normal_strength = s->setup.bond.shear_strength = INFINITY;
    memcpy(s->force[LAST], s->force[22], sizeof s->force[LAST]);
    for (int k = 0, after = 0; k < LOADS; k++) {
        if (k >= event[after + 1] && k < LAST) after++;
        const int from = event[after], to = event[after + 1];
        for (int i = 0; i < N && k > from && k < to; i++)
            s->force[k][i] = add(s->force[from][i],
                                 scale((double)(k - from) / (to - from),
                                       subtract(s->force[to][i], s->force[from][i])));
    }
    assert_int_equal(compare(s, LOADS), 0);
    s->force[8][38].z += 1e-9 * s->force[8][38].z; // off the line, by little
    assert_int_equal(compare(s, LOADS), 0);
    free_scene(s);
}

// The loads are looked at eight at a time: at the first, within, at the last of these,
// and after them. Under the earlier one bond breaks, under the later so many that all
// falls apart.
static void a_bond_breaks_at_any_of_them(void **state)
{
    (void)state;
    for (int jerk = 0; jerk < 10; jerk += jerk == 0 || jerk == 7 ? 1 : 3) {
        struct scene *s = make_scene(0.5, jerk, false);
        const int cracks = compare(s, LOADS);
        s->force[jerk][38].z -= jerk_force;
        assert_true(cracks > compare(s, LOADS));
        free_scene(s);
    }
}

// One bond is weaker than all others, which hold; more and more, in tension or in
// shear.
static void the_weak_one_breaks_at_its_load(void **state)
{
    (void)state;
    enum { WEAK = 70 };
    for (int mode = 0; mode < 2; mode++) {
        struct scene *s = make_scene(3, -1, false);
        s->setup.bond.normal_strength = mode == DEM_CRACK_NORMAL ? 1e9 : INFINITY;
        s->setup.bond.shear_strength = mode == DEM_CRACK_SHEAR ? 1e9 : INFINITY;
        double *relative = NEW_ARRAY(double, s->packing.n_bond);
        for (int b = 0; b < s->packing.n_bond; b++)
            relative[b] = 1;
        s->setup.relative_strength = relative;
        int held = 0, broke = 0;
        for (relative[WEAK] = 4e-6; relative[WEAK] < 1e-4; relative[WEAK] *= 1.7) {
            const int cracks = compare(s, LOADS);
            held += cracks == 0;
            broke += cracks == 1;
        }
        assert_true(held > 0 && broke > 1);
        free(relative);
        free_scene(s);
    }
}

static void nothing_holds_them(void **state)
{
    (void)state;
    struct scene *s = make_scene(2, 11, true);
    compare(s, LOADS);
    free_scene(s);
}

// Other loads than were expected come; and all contacts let go at once.
static void what_comes_is_not_what_was_expected(void **state)
{
    (void)state;
    struct scene *s = make_scene(3, -1, false);
    s->setup.bond.normal_strength = s->setup.bond.shear_strength = INFINITY;
    for (int i = 0; i < N; i++)
        s->force[13][i] = scale(-20, s->force[12][i]);
    struct outcome *right = find_all(s, LOADS);
    struct equilibrium *equilibrium = make_equilibrium(&s->setup);
    equilibrium_expect(equilibrium, LOADS, s->force[0]);
    for (int k = 0; k < LOADS; k += k == 4 ? 7 : 1) {
        struct vector moved[N];
        next_equilibrium(equilibrium, s->force[k]);
        equilibrium_displacements(equilibrium, moved);
        for (int i = 0; i < N; i++)
            assert_true(distance(moved[i], right->moved[k][i]) < 1e-8 * RADIUS);
    }
    equilibrium_free(equilibrium);
    free(right);
    compare(s, LOADS);
    free_scene(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contacts_open_and_close),
        cmocka_unit_test(loads_lie_on_lines),
        cmocka_unit_test(a_bond_breaks_at_any_of_them),
        cmocka_unit_test(the_weak_one_breaks_at_its_load),
        cmocka_unit_test(nothing_holds_them),
        cmocka_unit_test(what_comes_is_not_what_was_expected)};
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
