// SPDX-License-Identifier: GPL-3.0-or-later
// Grains of many sizes at irregular places, in both engines of the replay, equilibria
// for large displacements too: balance of the whole, energy, bonds that stay broken,
// and scenes that are turned or numbered anew.
#include "../dem_scene.h"
#include "../support_equilibrium.h"
#include "../support_irregular.h"
#include "dem-replay/bonds.h"
#include "dem-replay/support_reaction.h"
#include "load_in_memory.h"

enum { SIDE = 4, N = SIDE * SIDE * SIDE };

static const double size = 1e-9;    // N, of loads that crack
static const double strength = 6e4; // N/m2, the mean
static const struct vector axis = {1, 2, 3};
static const double full = 1;

// Both engines, equilibria for small displacements and for large ones.
enum way { CYCLES, SMALL, LARGE, WAYS };

static struct replay_settings settings_of(enum way way, uint8_t *held)
{
    return (struct replay_settings){
        .material = {.density = 3230,
                     .normal_stiffness = 3e4,
                     .shear_stiffness = 3e4,
                     .friction = 0.5,
                     .damping_ratio = 0.7},
        .bond = {8e16, 8e16, strength, strength, 0.5858, DEM_PARALLEL_BOND},
        .held = held,
        .support = SUPPORT_FIXED,
        .engine = way == CYCLES ? ENGINE_EXPLICIT : ENGINE_QUASI_STATIC,
        .large_displacements = way == LARGE,
        .increment = 0.02,
        .equilibrium_tolerance = 1e-12,
        .most_iterations = 40,
        .time_step_safety = 0.02,
        .cycles = 500,
        .tolerance = NAN,
        .n_snapshot = 1,
        .snapshot = &full,
        .threads = 1};
}

// Some bonds are weak: they break one here, one there, and the rest holds.
static double *weak_and_strong(const struct packing *packing)
{
    return draw_strengths(
        &(struct strength_scatter){.law = STRENGTH_WEIBULL, .modulus = 1.5, .seed = 1},
        packing->n_bond);
}

static double *in_stress(const double *relative, int n)
{
    double *each = NEW_ARRAY(double, n);
    for (int b = 0; b < n; b++)
        each[b] = strength * relative[b];
    return each;
}

// FORCE, grown to all of it in STEPS equal ones, and let go again in as many.
static struct load there_and_back(const struct vector *force, int n, int steps)
{
    struct rows_in_memory *rows = NEW_ARRAY(struct rows_in_memory, 1);
    struct load load = {.n_time = 2 * steps,
                        .time = NEW_ARRAY(double, 2 * steps),
                        .saturation = NEW_ARRAY(double, 2 * steps),
                        .source = rows,
                        .force = row_in_memory};
    *rows = (struct rows_in_memory){NEW_ARRAY(struct vector, 2 * steps * n), n};
    for (int k = 0; k < 2 * steps; k++)
        for (int i = 0; i < n; i++)
            rows->force[k * n + i] =
                scale(fmin(k + 1, 2 * steps - 1 - k) / steps, force[i]);
    return load;
}

static void load_free(struct load *load)
{
    free(load->time);
    free(load->saturation);
    free(((struct rows_in_memory *)load->source)->force);
    free(load->source);
}

// ---- the whole ----------------------------------------------------------------------

static struct vector moment_of(const struct packing *packing,
                               const struct vector *position,
                               const struct vector *force, double *total)
{
    struct vector sum = {0, 0, 0};
    *total = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        const struct vector from = subtract(position[i], packing->lower);
        sum = add(sum, cross(from, force[i]));
        *total += norm(from) * norm(force[i]);
    }
    return sum;
}

// What the load and the supports give is what the grains gain of momentum, in every
// cycle that is looked at: while bonds break and contacts slip.
TEST(the_whole_balances_in_motion)
{
    struct packing packing = irregular_packing(SIDE, RADIUS, false);
    uint8_t *held = lowest_grains(&packing, SIDE);
    struct dem_setup setup = stiff_setup(&packing);
    setup.bond.normal_stiffness = setup.bond.shear_stiffness = 8e16;
    double *relative = weak_and_strong(&packing);
    double *each = in_stress(relative, packing.n_bond);
    setup.normal_strength = setup.shear_strength = each;
    setup.fixed = held;
    struct dem *dem = create(&setup);
    free(relative);
    free(each);
    struct vector *whole = shrinking_load(&packing, size), force[N], position[N];
    for (int step = 1; step <= 40; step++) {
        struct vector net = {0, 0, 0};
        double total = 0, lever;
        for (int i = 0; i < N; i++) {
            force[i] = scale(step / 40.0, whole[i]);
            net = add(net, force[i]);
            total += norm(force[i]);
        }
        dem_set_force(dem, force);
        run(dem, 99);
        dem_positions(dem, position);
        const struct vector moment = moment_of(&packing, position, force, &lever);
        const struct dem_momentum before = dem_momentum(dem);
        run(dem, 1);
        const struct dem_momentum after = dem_momentum(dem);
        const struct net_load reaction = reaction_of_dem(&packing, dem, held, false);
        const double rate = 1 / dem_time_step(dem);
        const struct vector gain = scale(rate, subtract(after.linear, before.linear));
        const struct vector turn = scale(rate, subtract(after.angular, before.angular));
        assert_true(distance(add(net, reaction.force), gain) < 1e-10 * total);
        assert_true(distance(add(moment, reaction.moment), turn) < 1e-10 * lever);
        assert_true(norm(reaction.force) > 0.01 * norm(net));
    }
    int cracks;
    dem_cracks(dem, &cracks);
    assert_in_range(cracks, 5, packing.n_bond - 1);
    dem_free(dem);
    free(whole);
    free(held);
    packing_free(&packing);
}

static struct quasi_static *new_equilibrium(const struct packing *packing,
                                            const uint8_t *held, enum way way,
                                            double friction, const double *relative)
{
    const struct replay_settings settings = settings_of(way, NULL);
    struct quasi_static_setup setup = {.packing = packing,
                                       .fixed = held,
                                       .material = settings.material,
                                       .bond = settings.bond,
                                       .relative_strength = relative,
                                       .tolerance = 1e-12,
                                       .most_iterations = 40,
                                       .large_displacements = way == LARGE,
                                       .increment = settings.increment};
    setup.material.friction = friction;
    return make_equilibrium(&setup);
}

// Nothing is left, of forces and of moments about any point, which small displacements
// have where grains began.
static void check_rest(const struct packing *packing,
                       const struct quasi_static *equilibrium, const uint8_t *held,
                       const struct vector *force, enum way way)
{
    struct vector position[N], net = {0, 0, 0};
    double total = 0, lever;
    quasi_static_displacements(equilibrium, position);
    for (int i = 0; i < N; i++) {
        position[i] = add(packing->position[i], scale(way == LARGE, position[i]));
        net = add(net, force[i]);
        total += norm(force[i]);
    }
    const struct vector moment = moment_of(packing, position, force, &lever);
    const struct net_load reaction =
        reaction_of_equilibrium(packing, equilibrium, held, force);
    const double left = norm(add(net, reaction.force)) / total;
    const double turn = norm(add(moment, reaction.moment)) / lever;
    if (!(left < 1e-10 && (packing->periodic[0] || turn < 1e-10)))
        fail_msg("%g of the load, %g of its moment", left, turn);
}

static void check_balance_at_rest(const struct packing *packing, enum way way)
{
    uint8_t *held = lowest_grains(packing, SIDE);
    double *relative = weak_and_strong(packing);
    struct quasi_static *equilibrium =
        new_equilibrium(packing, held, way, 0.5, relative);
    struct vector *whole = shrinking_load(packing, size), force[N];
    const bool *is_gone = quasi_static_is_detached(equilibrium);
    int cracks = 0;
    for (int step = 1; step <= 20; step++) {
        for (int i = 0; i < N; i++)
            force[i] = scale(is_gone[i] ? 0 : step / 20.0, whole[i]);
        next_equilibrium(equilibrium, force);
        for (int i = 0; i < N; i++)
            if (is_gone[i]) force[i] = (struct vector){0, 0, 0};
        check_rest(packing, equilibrium, held, force, way);
    }
    quasi_static_cracks(equilibrium, &cracks);
    assert_in_range(cracks, 5, packing->n_bond - 1);
    quasi_static_free(equilibrium);
    free(relative);
    free(whole);
    free(held);
}

TEST(the_whole_balances_at_rest)
{
    for (int repeats = 0; repeats < 2; repeats++) {
        struct packing packing = irregular_packing(SIDE, RADIUS, repeats);
        check_balance_at_rest(&packing, SMALL);
        check_balance_at_rest(&packing, LARGE);
        packing_free(&packing);
    }
}

// Nothing moves grains that have left, rounding neither: what holds them no more than
// rounding does would let it take them any distance.
TEST(grains_that_left_stay_there)
{
    struct packing packing = irregular_packing(SIDE, RADIUS, false);
    uint8_t *held = lowest_grains(&packing, SIDE);
    double *relative = weak_and_strong(&packing);
    struct quasi_static *equilibrium =
        new_equilibrium(&packing, held, SMALL, 0, relative);
    struct vector *whole = shrinking_load(&packing, size), force[N], was[N], is[N];
    bool had_left[N] = {false};
    int compared = 0;
    for (int step = 1; step <= 20; step++) {
        for (int i = 0; i < N; i++)
            force[i] = scale(step / 20.0, whole[i]);
        next_equilibrium(equilibrium, force);
        quasi_static_displacements(equilibrium, is);
        for (int i = 0; i < N; i++) {
            compared += had_left[i];
            if (had_left[i]) assert_memory_equal(&is[i], &was[i], sizeof is[i]);
            had_left[i] = quasi_static_is_detached(equilibrium)[i];
        }
        memcpy(was, is, sizeof was);
    }
    assert_true(compared > 0);
    quasi_static_free(equilibrium);
    free(relative);
    free(whole);
    free(held);
    packing_free(&packing);
}

// ---- energy, and bonds that stay broken ---------------------------------------------

// What is missing of what came in, over some cycles of SAFETY.
static double imbalance(const struct packing *packing, const uint8_t *held,
                        const struct vector *force, double safety)
{
    struct dem_setup setup = stiff_setup(packing);
    setup.bond.normal_stiffness = setup.bond.shear_stiffness = 8e16;
    double *relative = weak_and_strong(packing);
    double *each = in_stress(relative, packing->n_bond);
    setup.normal_strength = setup.shear_strength = each;
    setup.balance_energy = true;
    setup.fixed = held;
    setup.material.damping_ratio = 0.2;
    setup.time_step_safety = safety;
    struct dem *dem = create(&setup);
    free(relative);
    free(each);
    dem_set_force(dem, force);
    struct dem_energy was = dem_energy(dem);
    for (int k = 0; k < 20; k++) {
        run(dem, (int64_t)(4 / safety));
        const struct dem_energy now = dem_energy(dem);
        assert_true(now.dashpots >= was.dashpots && now.slip >= was.slip &&
                    now.broken >= was.broken);
        was = now;
    }
    int cracks;
    dem_cracks(dem, &cracks);
    assert_in_range(cracks, 5, packing->n_bond);
    assert_true(was.broken > 0.01 * was.gained);
    const double lost = was.dashpots + was.slip + was.broken;
    dem_free(dem);
    return fabs(was.kinetic + was.elastic + lost - was.gained) / was.gained;
}

TEST(energy_is_not_created)
{
    for (int repeats = 0; repeats < 2; repeats++) {
        struct packing packing = irregular_packing(SIDE, RADIUS, repeats);
        uint8_t *held = lowest_grains(&packing, SIDE);
        struct vector *force = shrinking_load(&packing, size);
        const double coarse = imbalance(&packing, held, force, 0.02);
        const double fine = imbalance(&packing, held, force, 0.005);
        if (!(fine < 2e-3 && fine < 0.5 * coarse))
            fail_msg("missing %g, and %g in longer steps", fine, coarse);
        free(held);
        free(force);
        packing_free(&packing);
    }
}

// The work of a load that comes and goes, over the most of it on the way.
static double work_of_a_loop(double friction, const double *relative)
{
    struct packing packing = irregular_packing(SIDE, RADIUS, false);
    uint8_t *held = lowest_grains(&packing, SIDE);
    struct quasi_static *equilibrium =
        new_equilibrium(&packing, held, SMALL, friction, relative);
    struct vector *whole = shrinking_load(&packing, size);
    struct load load = there_and_back(whole, N, 20);
    struct vector was[N] = {{0, 0, 0}}, is[N];
    double work = 0, most = 0;
    for (int step = 0; step < load.n_time; step++) {
        next_equilibrium(equilibrium, row_in_memory(load.source, step));
        quasi_static_displacements(equilibrium, is);
        for (int i = 0; i < N; i++) {
            if (quasi_static_is_detached(equilibrium)[i]) continue;
            const struct vector before = step ? row_in_memory(load.source, step - 1)[i]
                                              : (struct vector){0, 0, 0};
            const struct vector mean =
                scale(0.5, add(before, row_in_memory(load.source, step)[i]));
            work += dot(mean, subtract(is[i], was[i]));
        }
        most = fmax(most, work);
        memcpy(was, is, sizeof was);
    }
    load_free(&load);
    quasi_static_free(equilibrium);
    free(whole);
    free(held);
    packing_free(&packing);
    return work / most;
}

// Equilibria give back what they took, to rounding; slip and bonds that break keep some
// of it.
TEST(a_loop_of_the_load_gains_nothing)
{
    struct packing packing = irregular_packing(SIDE, RADIUS, false);
    double *strong = NEW_ARRAY(double, packing.n_bond);
    double *relative = weak_and_strong(&packing);
    for (int b = 0; b < packing.n_bond; b++)
        strong[b] = 1e9;
    const double elastic = work_of_a_loop(0, strong);
    const double slip = work_of_a_loop(0.02, strong);
    const double cracks = work_of_a_loop(0, relative);
    if (!(fabs(elastic) < 1e-10 && slip > 1e-6 && cracks > 0.01))
        fail_msg("work of %g, with slip %g, with cracks %g", elastic, slip, cracks);
    free(strong);
    free(relative);
    packing_free(&packing);
}

// However the load comes and goes.
TEST(bonds_never_heal)
{
    struct packing packing = irregular_packing(SIDE, RADIUS, true);
    uint8_t *held = lowest_grains(&packing, SIDE);
    double *relative = weak_and_strong(&packing);
    struct vector *force = shrinking_load(&packing, size);
    struct load load = there_and_back(force, N, 10);
    for (enum way way = CYCLES; way < WAYS; way++) {
        struct replay_settings settings = settings_of(way, held);
        settings.relative_strength = relative;
        double snapshot[20];
        for (int k = 0; k < 20; k++) {
            load.saturation[k] = 1 - k / 20.0;
            snapshot[k] = load.saturation[k];
        }
        settings.snapshot = snapshot;
        settings.n_snapshot = 20;
        struct response response = replay_or_fail(&packing, &load, &settings);
        assert_int_equal(response.n_snapshot, 20);
        assert_in_range(response.n_crack, 5, packing.n_bond - 1);
        for (int k = 0; k < 20; k++) {
            int broken = 0;
            for (int b = 0; b < packing.n_bond; b++) {
                const bool intact = response.snapshot[k].intact[b];
                assert_false(k && intact && !response.snapshot[k - 1].intact[b]);
                broken += !intact;
            }
            assert_int_equal(broken, response.cracks[k]);
        }
        response_free(&response);
    }
    load_free(&load);
    free(relative);
    free(force);
    free(held);
    packing_free(&packing);
}

// ---- turned, and numbered anew ------------------------------------------------------

static int bond_between(const struct packing *packing, int i, int j)
{
    for (int b = 0; b < packing->n_bond; b++)
        if (packing->bond[b][0] == (i < j ? i : j) &&
            packing->bond[b][1] == (i < j ? j : i))
            return b;
    return -1;
}

// The largest difference, of the largest displacement; the same bonds must have broken.
static double difference(const struct packing *first, const struct response *a,
                         const struct packing *second, const struct response *b,
                         double angle, const int *order)
{
    double most = 0, largest = 0;
    int number[N];
    for (int i = 0; i < N; i++) {
        const struct vector was = a->snapshot[0].displacement[order[i]];
        const struct vector is = b->snapshot[0].displacement[i];
        most = fmax(most, distance(turned(was, axis, angle), is));
        largest = fmax(largest, norm(was));
        number[order[i]] = i;
    }
    for (int k = 0; k < first->n_bond; k++) {
        const int other =
            bond_between(second, number[first->bond[k][0]], number[first->bond[k][1]]);
        assert_true(other >= 0);
        assert_int_equal(a->snapshot[0].intact[k], b->snapshot[0].intact[other]);
    }
    return most / largest;
}

TEST(turned_and_renumbered_the_same)
{
    struct packing packing = irregular_packing(SIDE, RADIUS, false);
    int *order = shuffled(N, &(uint64_t){3});
    const double angle = 0.7;
    struct packing other = turned_packing(&packing, axis, angle, order);
    uint8_t *held = lowest_grains(&packing, SIDE), *held_there = NEW_ARRAY(uint8_t, N);
    double *relative = weak_and_strong(&packing);
    double *relative_there = NEW_ARRAY(double, packing.n_bond);
    struct vector *force = shrinking_load(&packing, size), there[N];
    int number[N];
    for (int i = 0; i < N; i++) {
        held_there[i] = held[order[i]];
        there[i] = turned(force[order[i]], axis, angle);
        number[order[i]] = i;
    }
    for (int b = 0; b < packing.n_bond; b++)
        relative_there[bond_between(&other, number[packing.bond[b][0]],
                                    number[packing.bond[b][1]])] = relative[b];
    struct load load = there_and_back(force, N, 5);
    struct load turned_load = there_and_back(there, N, 5);
    load.n_time = turned_load.n_time = 5; // there only
    const double last[1] = {0};
    for (int k = 0; k < 5; k++)
        load.saturation[k] = turned_load.saturation[k] = 4 - k;
    for (enum way way = CYCLES; way < WAYS; way++) {
        struct replay_settings settings = settings_of(way, held);
        settings.snapshot = last;
        settings.relative_strength = relative;
        struct response a = replay_or_fail(&packing, &load, &settings);
        settings.held = held_there;
        settings.relative_strength = relative_there;
        struct response b = replay_or_fail(&other, &turned_load, &settings);
        assert_in_range(a.n_crack, 5, packing.n_bond - 1);
        const double off = difference(&packing, &a, &other, &b, angle, order);
        if (!(off < 1e-7)) fail_msg("way %d: off by %g", (int)way, off);
        response_free(&a);
        response_free(&b);
    }
    load_free(&load);
    load_free(&turned_load);
    free(relative);
    free(relative_there);
    free(force);
    free(held);
    free(held_there);
    free(order);
    packing_free(&packing);
    packing_free(&other);
}

// A box that repeats may begin anywhere.
TEST(moved_across_the_sides_the_same)
{
    struct packing packing = irregular_packing(SIDE, RADIUS, true);
    struct packing other = turned_packing(&packing, axis, 0, NULL);
    other.lower = packing.lower;
    other.upper = packing.upper;
    const double edge = packing.upper.x - packing.lower.x;
    int order[N];
    for (int i = 0; i < N; i++) {
        order[i] = i;
        struct vector *x = &other.position[i];
        x->x = fmod(x->x + 0.37 * edge, edge);
        x->y = fmod(x->y + 0.81 * edge, edge);
    }
    uint8_t *held = lowest_grains(&packing, SIDE);
    double *relative = weak_and_strong(&packing);
    struct vector *force = shrinking_load(&packing, size);
    struct load load = there_and_back(force, N, 2);
    load.n_time = 2;
    const double last[1] = {0};
    load.saturation[0] = 1;
    for (enum way way = CYCLES; way < WAYS; way++) {
        struct replay_settings settings = settings_of(way, held);
        settings.snapshot = last;
        settings.relative_strength = relative;
        struct response a = replay_or_fail(&packing, &load, &settings);
        struct response b = replay_or_fail(&other, &load, &settings);
        assert_in_range(a.n_crack, 1, packing.n_bond - 1);
        const double off = difference(&packing, &a, &other, &b, 0, order);
        if (!(off < 1e-7)) fail_msg("way %d: off by %g", (int)way, off);
        response_free(&a);
        response_free(&b);
    }
    load_free(&load);
    free(relative);
    free(force);
    free(held);
    packing_free(&packing);
    packing_free(&other);
}

// Enough grains to share.
TEST(threads_make_no_difference)
{
    struct packing packing = irregular_packing(10, RADIUS, true);
    uint8_t *held = lowest_grains(&packing, 10);
    struct vector *force = shrinking_load(&packing, size);
    struct load load = there_and_back(force, packing.n_particle, 1);
    struct replay_settings settings = settings_of(CYCLES, held);
    double *relative = settings.relative_strength = weak_and_strong(&packing);
    struct response one = replay_or_fail(&packing, &load, &settings);
    settings.threads = 3;
    struct response three = replay_or_fail(&packing, &load, &settings);
    assert_in_range(one.n_crack, 5, packing.n_bond - 1);
    assert_int_equal(one.n_crack, three.n_crack);
    for (int k = 0; k < one.n_crack; k++)
        assert_int_equal(one.crack[k].bond, three.crack[k].bond);
    assert_memory_equal(one.snapshot[0].displacement, three.snapshot[0].displacement,
                        (size_t)packing.n_particle * sizeof(struct vector));
    assert_memory_equal(one.reaction, three.reaction, 2 * sizeof *one.reaction);
    response_free(&one);
    response_free(&three);
    load_free(&load);
    free(relative);
    free(force);
    free(held);
    packing_free(&packing);
}

// ---- one engine and the other -------------------------------------------------------

// So small a load that grains do not turn to speak of, without friction: cycles come to
// the equilibrium, the more of them the nearer.
TEST(cycles_come_to_equilibrium)
{
    for (int repeats = 0; repeats < 2; repeats++) {
        struct packing packing = irregular_packing(SIDE, RADIUS, repeats);
        uint8_t *held = lowest_grains(&packing, SIDE);
        struct vector *force = shrinking_load(&packing, 1e-6 * size), moved[N];
        struct quasi_static *equilibrium =
            new_equilibrium(&packing, held, SMALL, 0, NULL);
        struct reason reason = {""};
        if (quasi_static_solve(equilibrium, force, &reason))
            fail_msg("%s", reason.text);
        quasi_static_displacements(equilibrium, moved);
        double largest = 0, before = INFINITY;
        for (int i = 0; i < N; i++)
            largest = fmax(largest, norm(moved[i]));
        struct load load = there_and_back(force, N, 1);
        load.n_time = 1;
        for (int64_t cycles = 14000; cycles <= 56000; cycles += 14000) {
            struct replay_settings settings = settings_of(CYCLES, held);
            settings.material.friction = 0;
            settings.time_step_safety = 0.036;
            settings.cycles = cycles;
            struct response response = replay_or_fail(&packing, &load, &settings);
            double error = 0;
            for (int i = 0; i < N; i++)
                error = fmax(error,
                             distance(response.snapshot[0].displacement[i], moved[i]));
            error /= largest;
            response_free(&response);
            if (!(error < fmax(0.05 * before, 1e-10)))
                fail_msg("%lld cycles: %g after %g", (long long)cycles, error, before);
            before = error;
        }
        if (!(before < 1e-7)) fail_msg("off by %g in the end", before);
        load_free(&load);
        quasi_static_free(equilibrium);
        free(force);
        free(held);
        packing_free(&packing);
    }
}
