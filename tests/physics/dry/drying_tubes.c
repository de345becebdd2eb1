// SPDX-License-Identifier: GPL-3.0-or-later
// Tubes: chains of throats in series dry like a Stefan tube, and of tubes that share a
// reservoir the widest empties first.
#include "../../test.h"
#include "../support_lattice.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

static const double spacing = 5e-7;

// Leaves only the throats along z, and of those only the column at node COLUMN if it is
// not negative.
static void keep_columns(struct network *network, int column)
{
    const int n_column = 4;
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *node = network->throat_nodes[t];
        const bool vertical = node[1] - node[0] == n_column;
        if (!vertical || (column >= 0 && node[0] % n_column != column))
            network->throat_kind[t] = THROAT_IMPOSED_EMPTY;
    }
}

// Resistances in series: the boundary layer, then each empty throat.
static void check_chain(double spread, enum liquid_limit liquid)
{
    const int n = 40;
    struct network network = lattice_network(2, 2, n + 1, spacing);
    randomise_radii(&network, spacing, spread, 7);
    keep_columns(&network, 0);
    const struct drying_conditions conditions = kharaghani_conditions(liquid);
    struct drying_history history = dry_and_check(&network, &conditions);

    const double drop = log1p(2339 / (1e5 - 2339.0)) * conditions.diffusivity * 1e5 *
                        conditions.molar_mass / (GAS_CONSTANT * 293.15);
    double resistance =
        conditions.diffusivity / conditions.mass_transfer / (spacing * spacing);
    double time = 0;
    for (int k = 0; k < n; k++) {
        const int throat = lattice_throat(&network, 4 * (n - 1 - k), 2);
        const double radius = network.throat_radius[throat];
        assert_int_equal(history.event_throat[k], throat);
        assert_true(fabs(history.rate[k] * resistance / drop - 1) < 1e-12);
        assert_int_equal(history.clusters[k], 1);
        time += throat_volume(&network, throat) * conditions.liquid_density *
                resistance / drop;
        assert_true(fabs(history.time[k + 1] / time - 1) < 1e-12);
        resistance += spacing / (M_PI * radius * radius);
    }
    drying_history_free(&history);
    network_free(&network);
}

TEST(chain_is_resistances_in_series)
{
    check_chain(0.3, LIQUID_INVISCID);
    check_chain(0.3, LIQUID_IMMOBILE);
}

// Under a vanishing boundary layer the time of a tube is n (n-1) / 2 equal steps:
// Stefan's law of the square of the depth.
TEST(tube_dries_with_the_square_of_its_length)
{
    const int n = 64;
    struct network network = lattice_network(2, 2, n + 1, spacing);
    keep_columns(&network, 0);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    conditions.mass_transfer = 5.1e9;
    struct drying_history history = dry_and_check(&network, &conditions);
    for (int k = 4; k <= n / 2; k *= 2) {
        const double ratio = (double)(2 * k * (2 * k - 1)) / (k * (k - 1));
        assert_true(fabs(history.time[2 * k] / history.time[k] / ratio - 1) < 1e-8);
    }
    drying_history_free(&history);
    network_free(&network);
}

TEST(widest_tube_first)
{
    const int n = 9;
    struct network network = lattice_network(2, 2, n + 1, spacing);
    keep_columns(&network, -1);
    // Columns 0, 1, 3, 2 from wide to narrow go round the square, so that those left
    // are connected at the bottom, by throats that are narrower than all.
    const double factor[4] = {1.3, 1.2, 1.0, 1.1};
    for (int t = 0; t < network.n_throat; t++) {
        const int32_t *node = network.throat_nodes[t];
        if (network.throat_kind[t] == THROAT_NETWORK)
            network.throat_radius[t] *= factor[node[0] % 4];
        else if (node[1] < 4) {
            network.throat_kind[t] = THROAT_NETWORK;
            network.throat_radius[t] *= 0.5 + 0.01 * t;
        }
    }
    const struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    struct drying_history history = dry_and_check(&network, &conditions);
    const int order[4] = {0, 1, 3, 2};
    int n_emptied = 0; // of the tubes' throats, from the top of each to its bottom
    for (int k = 0; k < history.n_event; k++) {
        const int32_t *node = network.throat_nodes[history.event_throat[k]];
        if (node[1] < 4) continue;
        assert_int_equal(node[0] % 4, order[n_emptied / n]);
        assert_int_equal(node[0] / 4, n - 1 - n_emptied % n);
        n_emptied++;
    }
    drying_history_free(&history);
    network_free(&network);
}
