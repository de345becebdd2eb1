// SPDX-License-Identifier: GPL-3.0-or-later
// The two limits of the liquid on cubic lattices [K 5.4]: a flat front and one cluster
// where it is immobile; many clusters and a long first period where it has no
// viscosity.
#include "../../test.h"
#include "../support_lattice.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

static const double spacing = 5e-7;

static struct network sealed_lattice(int n, int nz)
{
    struct network network = lattice_network(n, n, nz, spacing);
    impose_empty_throats(&network, WALL_X_LOWER | WALL_X_UPPER | WALL_Y_LOWER |
                                       WALL_Y_UPPER | WALL_Z_LOWER);
    return network;
}

// Levels are numbered from the bottom; 0 is the lowest.
static int level(const struct network *network, int throat, int nodes_a_level)
{
    return network->throat_nodes[throat][0] / nodes_a_level;
}

// Until only the lowest throats are left, which nothing connects.
static void check_one_cluster(const struct drying_history *history)
{
    for (int k = 0; history->saturation[k] > 0.05; k++)
        assert_int_equal(history->clusters[k], 1);
}

// While a front of equal throats moves down, no throat of a level empties before all
// that lie two levels higher.
TEST(immobile_front_is_flat)
{
    const int n = 6, nz = 11;
    struct network network = sealed_lattice(n, nz);
    const struct drying_conditions conditions = kharaghani_conditions(LIQUID_IMMOBILE);
    struct drying_history history = dry_and_check(&network, &conditions);

    int full[11] = {0};
    for (int t = 0; t < network.n_throat; t++)
        full[level(&network, t, n * n)] += network.throat_kind[t] == THROAT_NETWORK;
    for (int k = 0; k < history.n_event; k++) {
        const int here = level(&network, history.event_throat[k], n * n);
        for (int above = here + 2; above < nz; above++)
            assert_int_equal(full[above], 0);
        full[here]--;
    }
    check_one_cluster(&history);
    drying_history_free(&history);
    network_free(&network);
}

TEST(immobile_rate_falls_from_the_first_moment)
{
    struct network network = sealed_lattice(6, 11);
    randomise_radii(&network, spacing, 0.02, 11);
    const struct drying_conditions conditions = kharaghani_conditions(LIQUID_IMMOBILE);
    struct drying_history history = dry_and_check(&network, &conditions);
    // No liquid comes up to keep the surface wet.
    assert_true(history.first_period_end_saturation > 0.9);
    for (int k = 0; k < history.n_step; k++)
        if (history.saturation[k] < 0.8)
            assert_true(history.rate[k] < 0.5 * history.rate[0]);
    check_one_cluster(&history);
    drying_history_free(&history);
    network_free(&network);
}

TEST(inviscid_has_clusters_and_a_first_period)
{
    struct network network = sealed_lattice(6, 11);
    randomise_radii(&network, spacing, 0.02, 11);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    struct drying_history history = dry_and_check(&network, &conditions);
    int most = 0;
    for (int k = 0; k < history.n_step; k++)
        most = history.clusters[k] > most ? history.clusters[k] : most;
    assert_true(most > 20);

    conditions.liquid = LIQUID_IMMOBILE;
    struct drying_history immobile = dry_and_check(&network, &conditions);
    assert_true(history.rate[0] == immobile.rate[0]);
    assert_true(history.first_period_end_saturation <
                immobile.first_period_end_saturation - 0.1);
    assert_true(history.breakthrough_saturation > immobile.breakthrough_saturation);
    drying_history_free(&immobile);
    drying_history_free(&history);
    network_free(&network);
}

TEST(breakthrough_is_when_gas_reaches_the_far_wall)
{
    struct network network = lattice_network(5, 4, 6, spacing);
    randomise_radii(&network, spacing, 0.3, 5);
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
        conditions.open_walls = 1u << wall;
        struct drying_history history = dry_and_check(&network, &conditions);
        const int opposite = wall % 2 ? 1 << (wall - 1) : 2 << wall;
        int event = 0, k = 0;
        for (bool reached = false; !reached; event++) {
            const int32_t *node = network.throat_nodes[history.event_throat[event]];
            reached =
                (network.node_walls[node[0]] | network.node_walls[node[1]]) & opposite;
        }
        while (history.time[k] < history.event_time[event - 1])
            k++;
        assert_true(history.breakthrough_saturation == history.saturation[k]);
        assert_true(history.saturation[k] > 0 && history.saturation[k] < 1);
        drying_history_free(&history);
    }
    network_free(&network);
}

// Radii from 1 to 199 % of the mean: conductances differ by up to 40,000 times.
TEST(wide_range_of_radii_dries_to_the_end)
{
    struct network network = lattice_network(8, 8, 8, spacing);
    randomise_radii(&network, spacing, 0.99, 23);
    for (int liquid = LIQUID_INVISCID; liquid <= LIQUID_IMMOBILE; liquid++) {
        const struct drying_conditions conditions =
            kharaghani_conditions((enum liquid_limit)liquid);
        struct drying_history history = dry_and_check(&network, &conditions);
        drying_history_free(&history);
    }
    network_free(&network);
}
