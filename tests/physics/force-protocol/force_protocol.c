// SPDX-License-Identifier: GPL-3.0-or-later
// Forces over time: two throats and two grains by hand, and the walk from step to step
// beside forces found anew.
#include "../../test.h"
#include "../support_lattice.h"
#include "basics/memory.h"
#include "bridges/bridges.h"
#include "force-protocol/pendular_rings.h"
#include "force-protocol/times.h"
#include "force_rows.h"
#include "geometry/auxiliary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void assert_same(double got, double wanted)
{
    if (!(fabs(got - wanted) <= 1e-14 * fmax(1, fabs(wanted))))
        fail_msg("got %.17g, wanted %.17g", got, wanted);
}

// ---- by hand ------------------------------------------------------------------------

// Throat 0 empties from time 0 to 1, throat 1 from 1 to 3. A suction of 10 Pa, half of
// which counts: F_0 = (5 s_0, 0, -2.5 s_1), F_1 = (0, 2.5 s_1, 0).
struct pair {
    struct network network;
    struct liquid_record record;
    struct suction_law law;
    struct throat_loads loads;
};

static struct pair two_throats(void)
{
    static int64_t offset[] = {0, 0, 1, 2};
    static int32_t throat[] = {0, 1};
    static double left[] = {0, 0}, time[] = {0, 1, 3}, saturation[] = {1, 0.5, 0};
    static bool exposed[3] = {true};
    struct pair pair = {.network = {.packing = {.n_particle = 2,
                                                .position = NEW_ARRAY(struct vector, 2),
                                                .lower = {1, 1, 1},
                                                .upper = {5, 5, 5}},
                                    .n_node = 3,
                                    .n_throat = 2,
                                    .throat_nodes = allocate(2, sizeof(int32_t[2])),
                                    .throat_radius = NEW_ARRAY(double, 2),
                                    .throat_kind = NEW_ARRAY(uint8_t, 2)},
                        .record = {.drying = {.n_step = 3,
                                              .time = time,
                                              .saturation = saturation,
                                              .offset = offset,
                                              .throat = throat,
                                              .throat_saturation = left},
                                   .exposed = exposed},
                        .law = {.rule = SUCTION_UNIFORM, .uniform = 10, .meniscus = 3},
                        .loads = {.scale = 0.5}};
    pair.network.packing.position[0] = (struct vector){2, 3, 3};
    pair.network.packing.position[1] = (struct vector){3, 3, 5};
    for (int t = 0; t < 2; t++) {
        pair.network.throat_nodes[t][0] = t;
        pair.network.throat_nodes[t][1] = t + 1;
        pair.network.throat_radius[t] = 1;
    }
    struct patches *patches = &pair.loads.patches[LOAD_SUCTION];
    patches_add(patches, 0, 0, (struct vector){0.25, 0, 0});
    patches_add(patches, 0, 0, (struct vector){0.75, 0, 0}); // one patch of both
    patches_add(patches, 1, 0, (struct vector){0, 0, -0.5});
    patches_add(patches, 1, 1, (struct vector){0, 0.5, 0});
    assert_int_equal(patches->n, 3);
    patches_sort(patches, 2);
    return pair;
}

static void pair_free(struct pair *pair)
{
    network_free(&pair->network);
    throat_loads_free(&pair->loads);
}

static struct process process_of(const struct pair *pair)
{
    return (struct process){&pair->network, &pair->record, &pair->law, &pair->loads};
}

// Of interpolation where only the first and the last time are taken.
static double error_between_the_ends(const struct pair *pair)
{
    const struct process process = process_of(pair);
    static const double ends[] = {0, 3};
    struct protocol protocol = protocol_begin(&process, ends, 2);
    while (protocol_next(&protocol))
        continue;
    const double error = protocol.interpolation.worst;
    protocol_free(&protocol);
    return error;
}

TEST(forces_at_uniform_times)
{
    struct pair pair = two_throats();
    const struct process process = process_of(&pair);
    double *time = uniform_times(&pair.record.drying, 7);
    double *saturation = saturations_at(&pair.record.drying, time, 7);
    struct vector *all;
    struct protocol protocol = whole_protocol(&process, time, 7, &all);
    for (int m = 0; m < 7; m++) {
        const double t = 0.5 * m, first = fmax(0, 1 - t);
        const double second = t < 1 ? 1 : (3 - t) / 2;
        assert_same(time[m], t);
        assert_same(saturation[m], 0.5 * (first + second));
        const struct vector *force = all + 2 * m;
        const struct vector wanted[2] = {{5 * first, 0, -2.5 * second},
                                         {0, 2.5 * second, 0}};
        for (int i = 0; i < 2; i++)
            assert_same(distance(force[i], wanted[i]), 0);
    }
    assert_same(protocol.measures.force, 5 * sqrt(1.25));
    assert_same(protocol.measures.change, 2.5);
    assert_same(protocol.interpolation.worst, 0);
    protocol_free(&protocol);
    free(saturation);
    free(time);
    free(all);

    // Only the ends: at time 1 a third of the way has gone, and F_0 = (0, 0, -2.5).
    assert_same(error_between_the_ends(&pair), 5 * sqrt(17) / 6);
    pair_free(&pair);
}

// The contact line of throat 1 pulls grain 1 with 8 N from the moment at which throat 0
// leaves gas at its end until it is empty itself; what is interpolated misses a jump by
// all of it.
TEST(what_jumps_is_missed)
{
    struct pair pair = two_throats();
    pair.law.contact_line = 16;
    struct patches *lines = &pair.loads.patches[LOAD_CONTACT_LINE];
    patches_add(lines, 1, 1, (struct vector){1, 0, 0});
    patches_sort(lines, 2);
    const struct process process = process_of(&pair);
    static const double time[] = {0, 1, 2, 3}, pull[] = {0, 8, 8, 0};
    struct vector *all;
    struct protocol protocol = whole_protocol(&process, time, 4, &all);
    for (int m = 0; m < 4; m++)
        assert_same(all[2 * m + 1].x, pull[m]);
    assert_same(protocol.interpolation.worst, 8);
    protocol_free(&protocol);
    free(all);

    // Beside jumps what bends without one counts as well: F_0 at time 1, as above.
    pair.law.contact_line = 0.016;
    assert_same(error_between_the_ends(&pair), 5 * sqrt(17) / 6);
    pair_free(&pair);
}

TEST(as_few_times_as_it_takes)
{
    struct pair pair = two_throats();
    const struct process process = process_of(&pair);
    // Of sqrt(31.25), by which both steps together change F_0; the first alone by 5,
    // the second by 2.5.
    static const struct {
        double bound;
        int count;
        double time[8];
    } row[] = {{1, 2, {0, 3}},
               {0.9, 3, {0, 1, 3}},
               {0.5, 4, {0, 0.5, 1, 3}},
               {0.4, 6, {0, 1. / 3, 2. / 3, 1, 2, 3}}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        double count;
        double *times = adaptive_times(&process, row[k].bound, row[k].count, &count);
        assert_same(count, row[k].count);
        assert_non_null(times);
        for (int m = 0; m < row[k].count; m++)
            assert_same(times[m], row[k].time[m]);
        free(times);
        assert_null(adaptive_times(&process, row[k].bound, row[k].count - 1, &count));
        assert_same(count, row[k].count);
    }
    pair_free(&pair);
}

// At time 0 forces of (5, 0, -2.5) at (-1, 0, 0) from the middle and 2.5 (0, 1, 0) at
// (0, 0, 2); their moments are (0, -2.5, 0) and (-5, 0, 0).
TEST(net_force_and_moment)
{
    struct pair pair = two_throats();
    const struct process process = process_of(&pair);
    static const double time[] = {0, 1, 2, 3};
    struct protocol protocol = protocol_begin(&process, time, 4);
    while (protocol_next(&protocol))
        continue;
    const struct measures *measures = &protocol.measures;
    assert_same(net_force(measures), sqrt(37.5) / (5 * sqrt(1.25) + 2.5));
    assert_same(net_moment(measures, &pair.network.packing),
                sqrt(31.25) / (5 * sqrt(1.25) + 5));
    pair.network.packing.periodic[1] = true;
    assert_same(net_moment(measures, &pair.network.packing), 0);
    protocol_free(&protocol);
    pair_free(&pair);
}

// Pressures in three snapshots; node 0 falls dry in the last, node 2 is in gas.
TEST(a_field_is_linear_between_snapshots)
{
    struct pair pair = two_throats();
    static double when[] = {0.5, 1, 2.5};
    static double pressure[] = {-4, -8, 0, -6, -14, 0, 0, -20, 0};
    pair.record.n_snapshot = 3;
    pair.record.snapshot_time = when;
    pair.record.pressure = pressure;
    pair.law.rule = SUCTION_FIELD;
    struct liquid_loads liquid =
        liquid_loads_begin(&pair.network, &pair.record, &pair.law);
    static const double time[] = {0, 0.75, 1, 1.5, 2.5, 3};
    static const double first[] = {6, 8, 10, 10 + 10. / 3, 20, 20};
    static const double second[] = {8, 11, 14, 16, 20, 20};
    for (int k = 0; k < 6; k++) {
        liquid_loads_to(&liquid, time[k]);
        assert_same(liquid.suction[0], first[k]);
        assert_same(liquid.suction[1], second[k]);
        double load[LOADS];
        liquid_loads_at(&liquid, 1, load);
        const double left = time[k] < 1 ? 1 : (3 - time[k]) / 2;
        assert_same(load[LOAD_SUCTION], left * second[k]);
    }
    // In the middle, a quarter of the way: 10 for 9.5 and 14 for 11, of 10.
    assert_same(field_error(&liquid), 0.5 * (0.5 + 3) / 10);
    liquid_loads_free(&liquid);
    pair_free(&pair);
}

TEST(auxiliary_grains_go)
{
    enum { N = 5, LEFT = 3 };
    static const uint8_t kind[N] = {0, GRAIN_AUXILIARY, 0, GRAIN_AUXILIARY, 0};
    static const int32_t bond[5][2] = {{0, 2}, {0, 1}, {1, 3}, {2, 4}, {3, 4}};
    struct packing packing = {.n_particle = N,
                              .n_bond = 5,
                              .position = NEW_ARRAY(struct vector, N),
                              .radius = NEW_ARRAY(double, N),
                              .kind = duplicate(kind, N, sizeof *kind),
                              .bond = duplicate(bond, 5, sizeof *bond)};
    struct vector force[N] = {0}, left[LEFT];
    for (int i = 0; i < N; i++) {
        packing.position[i].x = packing.radius[i] = 1 + i;
        force[i].y = 10 + i;
    }
    struct packing kept = without_auxiliary(&packing);
    copy_without_auxiliary(&packing, force, sizeof *force, left);
    assert_int_equal(kept.n_particle, LEFT);
    assert_null(kept.kind);
    assert_int_equal(kept.n_bond, 2);
    for (int b = 0; b < 2; b++)
        assert_true(kept.bond[b][0] == b && kept.bond[b][1] == b + 1);
    for (int i = 0; i < LEFT; i++) {
        assert_same(kept.position[i].x, 1 + 2 * i);
        assert_same(kept.radius[i], 1 + 2 * i);
        assert_same(left[i].y, 10 + 2 * i);
    }
    packing_free(&kept);
    packing_free(&packing);
}

// A ring left by liquid of a suction is the bridge that has this suction.
TEST(rings_have_the_suction_of_the_liquid)
{
    const struct ring_law law = {.rule = RING_SUCTION,
                                 .suction = 1e6,
                                 .surface_tension = 0.07,
                                 .contact_angle = 0.3};
    for (int other = 1; other <= 4; other++)
        for (int gap = 0; gap < 2; gap++) {
            const double radius[2] = {2.5e-7, 2.5e-7 * other}, apart = gap * 5e-9;
            double volume, force;
            struct reason reason;
            if (solve_ring(radius, apart, &law, &volume, &force, &reason))
                fail_msg("%s", reason.text);
            const struct bridge bridge = {.radius = {radius[0], radius[1]},
                                          .volume = volume,
                                          .surface_tension = 0.07,
                                          .contact_angle = {0.3, 0.3}};
            struct bridge_state found;
            if (bridge_solve(&bridge, apart, &found, &reason))
                fail_msg("%s", reason.text);
            assert_true(volume > 0 && fabs(found.suction / 1e6 - 1) < 1e-8);
            assert_true(fabs(found.force / force - 1) < 1e-8);
        }
}

// ---- from step to step --------------------------------------------------------------

// Random patches of all loads on the grains of a lattice that dries.
static struct throat_loads random_action(const struct network *network)
{
    struct throat_loads loads = {.scale = 2};
    uint64_t seed = 5;
    for (int l = 0; l < LOADS; l++) {
        for (int t = 0; t < network->n_throat; t++)
            for (int k = 0; k < 2; k++) {
                const double share = next_random(&seed);
                const int grain = (int)(share * network->packing.n_particle);
                const struct vector pull = {next_random(&seed), next_random(&seed),
                                            next_random(&seed)};
                patches_add(&loads.patches[l], t, grain, pull);
            }
        patches_sort(&loads.patches[l], network->packing.n_particle);
    }
    return loads;
}

TEST(the_walk_keeps_to_forces_found_anew)
{
    struct network network = lattice_network(4, 4, 5, 5e-7);
    randomise_radii(&network, 5e-7, 0.4, 3);
    const struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    struct drying_history history = dry_and_check(&network, &conditions);
    bool *exposed = NEW_ARRAY(bool, network.n_node);
    const struct liquid_record record = {
        .drying = {.n_step = history.n_step,
                   .time = history.time,
                   .saturation = history.saturation,
                   .offset = history.change_offset,
                   .throat = history.change_throat,
                   .throat_saturation = history.change_saturation},
        .exposed = exposed};
    const int n = network.packing.n_particle;
    struct vector *anew = NEW_ARRAY(struct vector, n);
    struct vector *before = NEW_ARRAY(struct vector, n);
    for (int which = 0; which < 4; which++) { // both rules, without lines and with
        const struct suction_law law = {.rule = which / 2 ? SUCTION_CLUSTERS
                                                          : SUCTION_UNIFORM,
                                        .uniform = 1,
                                        .meniscus = 1e-7,
                                        .contact_line = 1e6};
        struct throat_loads loads = random_action(&network);
        if (which % 2 == 0) patches_free(&loads.patches[LOAD_CONTACT_LINE]);
        struct force_steps steps = force_steps_begin(&loads, &network, &record, &law);
        int n_step = 1;
        do {
            forces_now(&loads, &steps.liquid, anew);
            for (int i = 0; i < n; i++)
                assert_same(distance(steps.force[i], anew[i]), 0);
            for (int k = 0; n_step > 1 && k < steps.n_changed; k++)
                assert_same(distance(steps.former[k], before[steps.changed[k]]), 0);
            memcpy(before, steps.force, (size_t)n * sizeof *before);
        } while (force_steps_advance(&steps) && ++n_step);
        assert_int_equal(n_step, record.drying.n_step);
        force_steps_free(&steps);
        throat_loads_free(&loads);
    }
    free(before);
    free(anew);
    free(exposed);
    drying_history_free(&history);
    network_free(&network);
}
