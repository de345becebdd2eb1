// SPDX-License-Identifier: GPL-3.0-or-later
// Which faces are open, and which throats are imposed empty.
#include "../../test.h"
#include "../support_lattice.h"

#include <stdbool.h>
#include <stdlib.h>

static const double spacing = 1e-6;
static const unsigned all_walls = (1u << WALL_COUNT) - 1;

// Of 1 kg/s through a unit of area over length.
static double rate_unit(const struct drying_conditions *conditions)
{
    return conditions->diffusivity * conditions->gas_pressure * conditions->molar_mass /
           (GAS_CONSTANT * conditions->temperature) *
           log(conditions->gas_pressure /
               (conditions->gas_pressure - conditions->saturation_pressure));
}

// A surface all wet evaporates its area over the thickness of the layer, on each open
// wall by itself, with a lattice or without.
TEST(first_rate_of_any_set)
{
    struct network network = lattice_network(4, 5, 6, spacing);
    const double area[3] = {4 * 5, 3 * 5, 3 * 4}; // of the walls across x, y, z
    for (unsigned walls = 1; walls <= all_walls; walls += 3)
        for (int lumped = 0; lumped < 2; lumped++) {
            struct drying_conditions conditions =
                kharaghani_conditions(LIQUID_IMMOBILE);
            conditions.open_walls = walls;
            conditions.lumped = lumped;
            struct drying_history history = dry_and_check(&network, &conditions);
            double open = 0;
            for (int wall = 0; wall < WALL_COUNT; wall++)
                if (walls >> wall & 1) open += area[wall / 2] * spacing * spacing;
            const double thickness = conditions.diffusivity / conditions.mass_transfer;
            const double rate = rate_unit(&conditions) * open / thickness;
            assert_true(fabs(history.rate[0] / rate - 1) < 1e-12);
            drying_history_free(&history);
        }
    network_free(&network);
}

// A cube dries alike through each of its faces.
TEST(each_face_alike)
{
    struct network network = lattice_network(5, 5, 5, spacing);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_IMMOBILE);
    struct drying_history first = dry_and_check(&network, &conditions);
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        conditions.open_walls = 1u << wall;
        struct drying_history history = dry_and_check(&network, &conditions);
        assert_int_equal(history.n_step, first.n_step);
        for (int k = 0; k < first.n_step; k++) {
            assert_true(fabs(history.saturation[k] - first.saturation[k]) < 1e-12);
            assert_true(fabs(history.rate[k] - first.rate[k]) < 1e-12 * first.rate[0]);
        }
        assert_true(fabs(history.breakthrough_saturation -
                         first.breakthrough_saturation) < 1e-12);
        drying_history_free(&history);
    }
    drying_history_free(&first);
    network_free(&network);
}

// One column of N throats open at both ends: of equal ones gas enters the lowest first,
// so that it comes up from below while the upper end stays wet.
TEST(tube_open_at_both_ends)
{
    const int n = 7;
    struct network network = lattice_column(n, spacing);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    conditions.open_walls = WALL_Z_LOWER | WALL_Z_UPPER;
    struct drying_history history = dry_and_check(&network, &conditions);
    const double r = 0.2 * spacing, throat = spacing / (M_PI * r * r);
    const double layer =
        conditions.diffusivity / conditions.mass_transfer / (spacing * spacing);
    for (int k = 0; k < n; k++) {
        const double rate = 1 / layer + 1 / (layer + k * throat);
        assert_true(fabs(history.rate[k] / (rate_unit(&conditions) * rate) - 1) <
                    1e-12);
    }
    assert_true(history.breakthrough_saturation == 0); // no far wall is closed
    drying_history_free(&history);
    network_free(&network);
}

// The rate goes with ln((p_g - p_air) / (p_g - p_sat)), and the order stays.
TEST(humidity_of_the_air)
{
    struct network network = lattice_network(5, 5, 5, spacing);
    randomise_radii(&network, spacing, 0.3, 8);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    struct drying_history dry = dry_and_check(&network, &conditions);
    for (double share = 0.1; share < 1; share += 0.29) {
        conditions.air_vapour_pressure = share * 2339;
        struct drying_history humid = dry_and_check(&network, &conditions);
        const double slower =
            log((1e5 - share * 2339) / (1e5 - 2339)) / log(1e5 / (1e5 - 2339));
        for (int k = 0; k < dry.n_event; k++) {
            assert_int_equal(humid.event_throat[k], dry.event_throat[k]);
            assert_true(fabs(humid.rate[k] / dry.rate[k] / slower - 1) < 1e-12);
        }
        drying_history_free(&humid);
    }
    drying_history_free(&dry);
    network_free(&network);
}

// Those along one wall hold nothing and never take part; the rest dries.
TEST(imposed_empty_walls)
{
    struct network network = lattice_network(5, 4, 6, spacing);
    randomise_radii(&network, spacing, 0.3, 9);
    int along = 0;
    for (int t = 0; t < network.n_throat; t++)
        along +=
            network.throat_nodes[t][0] % 5 == 0 && network.throat_nodes[t][1] % 5 == 0;
    assert_int_equal(impose_empty_throats(&network, WALL_X_LOWER), along);
    const struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    struct drying_history history = dry_and_check(&network, &conditions);
    for (int k = 0; k < history.n_event; k++)
        assert_int_equal(network.throat_kind[history.event_throat[k]], THROAT_NETWORK);
    drying_history_free(&history);
    network_free(&network);
}
