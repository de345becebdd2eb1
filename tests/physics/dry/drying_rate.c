// SPDX-License-Identifier: GPL-3.0-or-later
// The rate of a fully wet surface is known in closed form: one-dimensional diffusion
// through the boundary layer, whatever the network below [K 3.9].
#include "../../test.h"
#include "../support_lattice.h"

static double wet_surface_rate(const struct drying_conditions *conditions, double area)
{
    const double thickness = conditions->diffusivity / conditions->mass_transfer;
    return area * conditions->diffusivity / thickness * conditions->gas_pressure *
           conditions->molar_mass / (GAS_CONSTANT * conditions->temperature) *
           log((conditions->gas_pressure - conditions->air_vapour_pressure) /
               (conditions->gas_pressure - conditions->saturation_pressure));
}

static void check_first_rate(const struct network *network,
                             const struct drying_conditions *conditions, double area,
                             double tolerance)
{
    struct drying_history history = dry_and_check(network, conditions);
    const double expected = wet_surface_rate(conditions, area);
    assert_true(fabs(history.rate[0] / expected - 1) < tolerance);
    drying_history_free(&history);
}

TEST(first_rate)
{
    const double spacing = 5e-7;
    struct network network = lattice_network(4, 5, 6, spacing);
    randomise_radii(&network, spacing, 0.1, 1);
    const int cubes[3] = {4 * 5, 3 * 5, 3 * 4};
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        conditions.open_walls = 1u << wall;
        check_first_rate(&network, &conditions, cubes[wall / 2] * spacing * spacing,
                         1e-12);
    }
    network_free(&network);
}

TEST(imposed_empty_sides_leave_the_area_whole)
{
    const double spacing = 5e-7;
    struct network network = lattice_network(6, 6, 11, spacing);
    const unsigned walls =
        WALL_X_LOWER | WALL_X_UPPER | WALL_Y_LOWER | WALL_Y_UPPER | WALL_Z_LOWER;
    // Throats in a plane of m by n nodes: m (n-1) + n (m-1); those on the four vertical
    // edges and the four lower ones lie in two of the five walls.
    assert_int_equal(impose_empty_throats(&network, walls),
                     4 * (6 * 10 + 11 * 5) + 60 - 4 * 10 - 4 * 5);
    const struct drying_conditions conditions = kharaghani_conditions(LIQUID_IMMOBILE);
    check_first_rate(&network, &conditions, 25 * spacing * spacing, 1e-12);

    struct drying_history history = dry_and_check(&network, &conditions);
    assert_int_equal(history.boundary_layers, 10);
    assert_true(fabs(history.boundary_layer_thickness / 5.0362745e-6 - 1) < 1e-8);
    drying_history_free(&history);
    network_free(&network);
}

TEST(number_of_layers_does_not_matter_while_all_is_wet)
{
    const double spacing = 5e-7;
    struct network network = lattice_network(3, 3, 3, spacing);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    const int layers[] = {1, 2, 7, 100};
    for (int k = 0; k < 4; k++) {
        conditions.layers = layers[k];
        check_first_rate(&network, &conditions, 4 * spacing * spacing, 1e-12);
    }
    network_free(&network);
}

// log() above has few digits left when a pressure is near another; log1p of the right
// ratio has them all.
TEST(extreme_pressures)
{
    const double spacing = 5e-7;
    struct network network = lattice_network(3, 3, 3, spacing);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    conditions.saturation_pressure = 1e5 * (1 - 0x1p-40);
    check_first_rate(&network, &conditions, 4 * spacing * spacing, 1e-12);

    conditions.saturation_pressure = 1e-9;
    struct drying_history history = dry_and_check(&network, &conditions);
    const double vapour_density =
        1e-9 * conditions.molar_mass / (GAS_CONSTANT * conditions.temperature);
    const double expected =
        4 * spacing * spacing * conditions.mass_transfer * vapour_density;
    assert_true(fabs(history.rate[0] / expected - 1) < 1e-12); // Stefan flow vanishes
    drying_history_free(&history);
    network_free(&network);
}
