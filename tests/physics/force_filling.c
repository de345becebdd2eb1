// SPDX-License-Identifier: GPL-3.0-or-later
// The liquid as force-protocol follows it, beside the drying it comes from.
#include "../test.h"
#include "basics/memory.h"
#include "force-protocol/filling.h"
#include "support_lattice.h"

#include <stdlib.h>

struct dried {
    struct network network;
    struct drying_history history;
    struct filling_record record;
};

static struct dried dry_lattice(uint64_t seed)
{
    struct dried dried = {.network = lattice_network(5, 5, 7, 5e-7)};
    randomise_radii(&dried.network, 5e-7, 0.4, seed);
    const struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    dried.history = dry_and_check(&dried.network, &conditions);
    struct drying_history *history = &dried.history;
    dried.record = (struct filling_record){
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

static void dried_free(struct dried *dried)
{
    free(dried->record.exposed);
    drying_history_free(&dried->history);
    network_free(&dried->network);
}

static const struct suction_law by_clusters = {
    .rule = SUCTION_CLUSTERS, .uniform = 1e6, .meniscus = 0.14, .contact_line = 0.03};

static void clusters_are_those_of_the_drying(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct dried dried = dry_lattice(seed);
        struct filling filling =
            filling_begin(&dried.network, &dried.record, &by_clusters);
        int *cluster = NEW_ARRAY(int, dried.network.n_throat);
        for (int step = 0; step < dried.record.drying.n_step; step++) {
            if (step > 0) filling_advance(&filling);
            assert_int_equal(filling_clusters(&filling, cluster),
                             dried.history.clusters[step]);
        }
        free(cluster);
        filling_free(&filling);
        dried_free(&dried);
    }
}

// Gas goes next into the throat of least suction: what empties at the end of a step had
// the suction of its cluster.
static void a_cluster_has_the_suction_of_what_empties_next(void **state)
{
    (void)state;
    struct dried dried = dry_lattice(7);
    struct filling filling = filling_begin(&dried.network, &dried.record, &by_clusters);
    int checked = 0;
    for (int step = 0; step + 1 < dried.record.drying.n_step; step++) {
        if (step > 0) filling_advance(&filling);
        for (int64_t k = dried.record.drying.offset[step + 1];
             k < dried.record.drying.offset[step + 2]; k++) {
            if (dried.record.drying.throat_saturation[k] > 0) continue;
            const int throat = dried.record.drying.throat[k];
            double load[LOADS];
            filling_to_end_of_step(&filling);
            filling_loads(&filling, throat, load);
            assert_true(load[LOAD_SUCTION] == 0 && load[LOAD_EMPTINESS] == 1);
            const double wanted = 0.14 / dried.network.throat_radius[throat];
            assert_true(fabs(filling.suction[throat] / wanted - 1) < 1e-15);
            checked++;
        }
    }
    assert_true(checked > 400);
    filling_free(&filling);
    dried_free(&dried);
}

// While all is wet only the throats at the open surface have menisci: one at their
// upper end, two where they lie in it.
static void menisci_begin_at_the_open_surface(void **state)
{
    (void)state;
    struct dried dried = dry_lattice(2);
    struct filling filling = filling_begin(&dried.network, &dried.record, &by_clusters);
    double widest = 0;
    for (int t = 0; t < dried.network.n_throat; t++) {
        const int32_t *node = dried.network.throat_nodes[t];
        const int ends = dried.record.exposed[node[0]] + dried.record.exposed[node[1]];
        double load[LOADS];
        filling_loads(&filling, t, load);
        assert_true(load[LOAD_CONTACT_LINE] ==
                    0.03 * dried.network.throat_radius[t] * ends);
        assert_true(load[LOAD_EMPTINESS] == 0);
        if (ends > 0) widest = fmax(widest, dried.network.throat_radius[t]);
    }
    for (int t = 0; t < dried.network.n_throat; t++) // all in one piece
        assert_true(fabs(filling.suction[t] * widest / 0.14 - 1) < 1e-15);
    filling_free(&filling);
    dried_free(&dried);
}

int main(void)
{
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clusters_are_those_of_the_drying),
        cmocka_unit_test(a_cluster_has_the_suction_of_what_empties_next),
        cmocka_unit_test(menisci_begin_at_the_open_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
