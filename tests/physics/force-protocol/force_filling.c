// SPDX-License-Identifier: GPL-3.0-or-later
// The liquid as force-protocol follows it, beside the drying it comes from.
#include "../../test.h"
#include "../support_lattice.h"
#include "basics/memory.h"
#include "force-protocol/liquid_loads.h"

#include <stdlib.h>

struct dried {
    struct network network;
    struct drying_history history;
    struct liquid_record record;
};

static struct dried dry_lattice_under(double gravity, uint64_t seed)
{
    struct dried dried = {.network = lattice_network(5, 5, 7, 5e-7)};
    randomise_radii(&dried.network, 5e-7, 0.4, seed);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    conditions.gravity = gravity;
    dried.history = dry_and_check(&dried.network, &conditions);
    struct drying_history *history = &dried.history;
    dried.record = (struct liquid_record){
        .drying = {.n_step = history->n_step,
                   .time = history->time,
                   .saturation = history->saturation,
                   .offset = history->change_offset,
                   .throat = history->change_throat,
                   .throat_saturation = history->change_saturation},
        .exposed = NEW_ARRAY(bool, dried.network.n_node)};
    for (int i = 0; i < dried.network.n_node; i++)
        dried.record.exposed[i] = dried.network.node_walls[i] & WALL_Z_UPPER;
    return dried;
}

static struct dried dry_lattice(uint64_t seed)
{
    return dry_lattice_under(0, seed);
}

static void dried_free(struct dried *dried)
{
    free(dried->record.exposed);
    free(dried->record.snapshot_time);
    free(dried->record.pressure);
    drying_history_free(&dried->history);
    network_free(&dried->network);
}

static const struct suction_law by_clusters = {
    .rule = SUCTION_CLUSTERS, .uniform = 1e6, .meniscus = 0.14, .contact_line = 0.03};

TEST(clusters_are_those_of_the_drying)
{
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct dried dried = dry_lattice(seed);
        struct liquid_loads liquid =
            liquid_loads_begin(&dried.network, &dried.record, &by_clusters);
        int *cluster = NEW_ARRAY(int, dried.network.n_throat);
        for (int step = 0; step < dried.record.drying.n_step; step++) {
            if (step > 0) liquid_loads_advance(&liquid);
            assert_int_equal(liquid_loads_clusters(&liquid, cluster),
                             dried.history.clusters[step]);
        }
        free(cluster);
        liquid_loads_free(&liquid);
        dried_free(&dried);
    }
}

// Gas goes next into the throat of least suction: what empties at the end of a step had
// the suction of its cluster.
static void empties_next(double gravity)
{
    struct dried dried = dry_lattice_under(gravity, 7);
    struct suction_law law = by_clusters;
    law.meniscus = 2 * kharaghani_conditions(LIQUID_INVISCID).surface_tension;
    law.weight = kharaghani_conditions(LIQUID_INVISCID).liquid_density * gravity;
    struct liquid_loads liquid =
        liquid_loads_begin(&dried.network, &dried.record, &law);
    int checked = 0;
    for (int step = 0; step + 1 < dried.record.drying.n_step; step++) {
        if (step > 0) liquid_loads_advance(&liquid);
        for (int64_t k = dried.record.drying.offset[step + 1];
             k < dried.record.drying.offset[step + 2]; k++) {
            if (dried.record.drying.throat_saturation[k] > 0) continue;
            const int throat = dried.record.drying.throat[k];
            double load[LOADS];
            liquid_loads_to_end_of_step(&liquid);
            liquid_loads_at(&liquid, throat, load);
            assert_true(load[LOAD_SUCTION] == 0 && load[LOAD_EMPTINESS] == 1);
            const double wanted = law.meniscus / dried.network.throat_radius[throat];
            assert_true(fabs(liquid.suction[throat] / wanted - 1) < 1e-14);
            checked++;
        }
    }
    assert_true(checked > 400);
    liquid_loads_free(&liquid);
    dried_free(&dried);
}

TEST(a_cluster_has_the_suction_of_what_empties_next)
{
    empties_next(0);
}

// Under weight gas does not go next into the widest throat, and the suction grows with
// height: by as much as a whole meniscus over this lattice.
TEST(so_it_has_under_weight)
{
    empties_next(3e8);
}

// While all is wet only the throats at the open surface have menisci: one at their
// upper end, two where they lie in it.
TEST(menisci_begin_at_the_open_surface)
{
    struct dried dried = dry_lattice(2);
    struct liquid_loads liquid =
        liquid_loads_begin(&dried.network, &dried.record, &by_clusters);
    double widest = 0;
    for (int t = 0; t < dried.network.n_throat; t++) {
        const int32_t *node = dried.network.throat_nodes[t];
        const int ends = dried.record.exposed[node[0]] + dried.record.exposed[node[1]];
        double load[LOADS];
        liquid_loads_at(&liquid, t, load);
        assert_true(load[LOAD_CONTACT_LINE] ==
                    0.03 * dried.network.throat_radius[t] * ends);
        assert_true(load[LOAD_EMPTINESS] == 0);
        if (ends > 0) widest = fmax(widest, dried.network.throat_radius[t]);
    }
    for (int t = 0; t < dried.network.n_throat; t++) // all in one piece
        assert_true(fabs(liquid.suction[t] * widest / 0.14 - 1) < 1e-15);
    liquid_loads_free(&liquid);
    dried_free(&dried);
}

// One throat has emptied and one half before the first step, which is the last; one was
// never to hold liquid, and leaves neither gas nor rings.
TEST(a_drying_may_begin_with_some_throats_empty)
{
    enum { EMPTY = 20, HALF = 30, NEVER = 40 };
    struct network network = lattice_network(4, 4, 4, 1);
    network.throat_kind[NEVER] = THROAT_IMPOSED_EMPTY;
    int64_t offset[] = {0, 3};
    int32_t throat[] = {EMPTY, HALF, NEVER};
    double left[] = {0, 0.5, 0}, time[] = {0}, saturation[] = {0.75};
    const struct liquid_record record = {.drying = {.n_step = 1,
                                                    .time = time,
                                                    .saturation = saturation,
                                                    .offset = offset,
                                                    .throat = throat,
                                                    .throat_saturation = left},
                                         .exposed = NEW_ARRAY(bool, network.n_node)};
    const struct suction_law law = {
        .rule = SUCTION_UNIFORM, .uniform = 7, .contact_line = 1};
    struct liquid_loads liquid = liquid_loads_begin(&network, &record, &law);
    const int32_t *gas = network.throat_nodes[EMPTY];
    double *saturations = saturations_at(&record.drying, time, 1);
    assert_true(saturations[0] == 0.75);
    free(saturations);
    for (int t = 0; t < network.n_throat; t++) {
        const double wet = t == EMPTY || t == NEVER ? 0 : t == HALF ? 0.5 : 1;
        int menisci = 0;
        for (int end = 0; end < 2; end++) {
            const int node = network.throat_nodes[t][end];
            menisci += node == gas[0] || node == gas[1];
        }
        double load[LOADS];
        liquid_loads_at(&liquid, t, load);
        assert_true(load[LOAD_SUCTION] == 7 * wet);
        assert_true(load[LOAD_EMPTINESS] == (t == NEVER ? 0 : 1 - wet));
        assert_true(load[LOAD_CONTACT_LINE] ==
                    (wet > 0 ? menisci * network.throat_radius[t] : 0));
    }
    liquid_loads_free(&liquid);
    free(record.exposed);
    network_free(&network);
}

// ---- a field ------------------------------------------------------------------------

// Three snapshots, the middle one nearer to the first; a third of the nodes is in gas,
// which ones changes, and a throat is closed.
enum { SNAPSHOTS = 3 };
static const struct suction_law by_field = {
    .rule = SUCTION_FIELD, .uniform = 1e6, .meniscus = 0.14};

static struct dried dry_with_field(void)
{
    struct dried dried = dry_lattice(4);
    const int n_node = dried.network.n_node;
    const double *time = dried.record.drying.time;
    const double end = time[dried.record.drying.n_step - 1];
    const double when[SNAPSHOTS] = {0.1 * end, 0.3 * end, 0.9 * end};
    uint64_t seed = 3;
    dried.network.throat_radius[5] = 0;
    dried.record.n_snapshot = SNAPSHOTS;
    dried.record.snapshot_time = duplicate(when, SNAPSHOTS, sizeof *when);
    dried.record.pressure = NEW_ARRAY(double, SNAPSHOTS *n_node);
    for (int k = 0; k < SNAPSHOTS * n_node; k++)
        if (next_random(&seed) > 1.0 / 3)
            dried.record.pressure[k] = -1e6 * (1 + next_random(&seed));
    return dried;
}

// The suction in a snapshot: the mean of the ends in liquid, or that of a meniscus.
static double in_snapshot(const struct dried *dried, int s, int throat)
{
    const double *pressure = dried->record.pressure + s * dried->network.n_node;
    const double one = pressure[dried->network.throat_nodes[throat][0]];
    const double other = pressure[dried->network.throat_nodes[throat][1]];
    if (one < 0 && other < 0) return -(one + other) / 2;
    if (one < 0 || other < 0) return -(one + other);
    const double radius = dried->network.throat_radius[throat];
    return throat == 5 ? 1e6 : 0.14 / radius;
}

static void check_field(const struct dried *dried, const struct liquid_loads *liquid,
                        double time)
{
    const double *when = dried->record.snapshot_time;
    const int s = time < when[1] ? 0 : 1;
    const double share = fmin(1, fmax(0, (time - when[s]) / (when[s + 1] - when[s])));
    for (int t = 0; t < dried->network.n_throat; t++)
        assert_close(liquid->suction[t],
                     (1 - share) * in_snapshot(dried, s, t) +
                         share * in_snapshot(dried, s + 1, t),
                     1e-14);
}

// At both ends of each step, and from there or from the beginning.
TEST(a_field_is_that_of_the_time)
{
    struct dried dried = dry_with_field();
    const struct drying_record *drying = &dried.record.drying;
    struct liquid_loads walking =
        liquid_loads_begin(&dried.network, &dried.record, &by_field);
    struct liquid_loads going =
        liquid_loads_begin(&dried.network, &dried.record, &by_field);
    for (int step = 0; step + 1 < drying->n_step; step++) {
        if (step > 0) liquid_loads_advance(&walking);
        check_field(&dried, &walking, drying->time[step]);
        liquid_loads_to_end_of_step(&walking);
        check_field(&dried, &walking, drying->time[step + 1]);
        liquid_loads_to(&going, drying->time[step]);
        check_field(&dried, &going, drying->time[step]);
    }
    liquid_loads_free(&going);
    liquid_loads_free(&walking);
    dried_free(&dried);
}

// Of what holds liquid in all three snapshots: the middle one beside a quarter of the
// way, or beside the first where all three are of one time.
TEST(the_error_of_a_field_is_what_the_middle_snapshot_adds)
{
    struct dried dried = dry_with_field();
    struct liquid_loads liquid =
        liquid_loads_begin(&dried.network, &dried.record, &by_field);
    double sum = 0, at_once = 0;
    int count = 0;
    for (int t = 0; t < dried.network.n_throat; t++) {
        double suction[SNAPSHOTS];
        int wet = 0;
        for (int s = 0; s < SNAPSHOTS; s++) {
            const double *pressure = dried.record.pressure + s * dried.network.n_node;
            const int32_t *node = dried.network.throat_nodes[t];
            wet += pressure[node[0]] < 0 || pressure[node[1]] < 0;
            suction[s] = in_snapshot(&dried, s, t);
        }
        if (wet < SNAPSHOTS) continue;
        sum += fabs(suction[1] - 0.75 * suction[0] - 0.25 * suction[2]);
        at_once += fabs(suction[1] - suction[0]);
        count++;
    }
    assert_true(count > 200 && count < dried.network.n_throat - 50);
    assert_close(field_error(&liquid), sum / count / 1e6, 1e-13);
    for (int s = 0; s < SNAPSHOTS; s++)
        dried.record.snapshot_time[s] = 0;
    assert_close(field_error(&liquid), at_once / count / 1e6, 1e-13);
    liquid_loads_free(&liquid);
    dried_free(&dried);
}

// Clusters have the same suction whichever way the filling has come to the step.
TEST(steps_are_the_filling_of_their_times)
{
    struct dried dried = dry_lattice(6);
    const struct drying_record *drying = &dried.record.drying;
    struct liquid_loads walking =
        liquid_loads_begin(&dried.network, &dried.record, &by_clusters);
    for (int step = 1; step + 1 < drying->n_step; step++) {
        liquid_loads_advance(&walking);
        if (!(drying->time[step] < drying->time[step + 1])) continue;
        struct liquid_loads going =
            liquid_loads_begin(&dried.network, &dried.record, &by_clusters);
        liquid_loads_to(&going, drying->time[step]);
        assert_int_equal(going.step, step);
        for (int t = 0; t < dried.network.n_throat; t++) {
            double one[LOADS], other[LOADS];
            liquid_loads_at(&walking, t, one);
            liquid_loads_at(&going, t, other);
            assert_memory_equal(one, other, sizeof one);
        }
        liquid_loads_free(&going);
    }
    liquid_loads_free(&walking);
    dried_free(&dried);
}
