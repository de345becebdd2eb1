// SPDX-License-Identifier: GPL-3.0-or-later
// What cannot dry is refused, with the name of what is wrong; extremes that can, dry.
#include "../../test.h"
#include "../support_lattice.h"

#include <string.h>

static const double spacing = 5e-7;

static void check_refused(const struct network *network,
                          const struct drying_conditions *conditions, const char *named)
{
    struct drying_history history;
    struct reason reason = {""};
    assert_int_equal(dry_network(network, conditions, NULL, &history, &reason),
                     STATUS_BAD_DATA);
    if (!strstr(reason.text, named))
        fail_msg("'%s' does not name '%s'", reason.text, named);
    drying_history_free(&history);
}

TEST(impossible_conditions)
{
    struct network network = lattice_network(3, 3, 3, spacing);
    const struct drying_conditions good = kharaghani_conditions(LIQUID_INVISCID);
    struct drying_conditions bad;
#define REFUSE(field, value)                                                           \
    (bad = good, bad.field = value, check_refused(&network, &bad, #field))
    REFUSE(temperature, 0);
    REFUSE(temperature, -293);
    REFUSE(temperature, NAN);
    REFUSE(gas_pressure, 0);
    REFUSE(gas_pressure, INFINITY);
    REFUSE(saturation_pressure, 0);
    REFUSE(saturation_pressure, 1e5);
    REFUSE(saturation_pressure, 2e5);
    REFUSE(air_vapour_pressure, -1);
    REFUSE(air_vapour_pressure, 2339);
    REFUSE(air_vapour_pressure, 3000);
    REFUSE(air_vapour_pressure, NAN);
    REFUSE(diffusivity, 0);
    REFUSE(molar_mass, 0);
    REFUSE(liquid_density, 0);
    REFUSE(mass_transfer, 0);
    REFUSE(layers, -1);
    REFUSE(vapour_tolerance, -1e-9);
    REFUSE(vapour_tolerance, 1e-7);
    REFUSE(vapour_tolerance, 0.6);
    REFUSE(vapour_tolerance, NAN);
    REFUSE(vapour_step, -0.1);
    REFUSE(vapour_step, 0.6);
    REFUSE(vapour_step, NAN);
    REFUSE(first_period_rate_fraction, 0);
    REFUSE(first_period_rate_fraction, 1);
#undef REFUSE
    bad = good;
    bad.mass_transfer = 1e-300;
    check_refused(&network, &bad, "layers");
    bad = good;
    bad.open_walls = 0;
    check_refused(&network, &bad, "open wall");
    bad.open_walls = 64;
    check_refused(&network, &bad, "open wall");
    network_free(&network);
}

TEST(impossible_networks)
{
    const struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    struct network network = lattice_network(3, 3, 3, spacing);
    network.throat_length[7] = 0;
    check_refused(&network, &conditions, "/throats/length: row 7");
    check_refused(&network, &conditions, "merge-nodes removes short throats");
    network.throat_length[7] = spacing;
    network.throat_radius[9] = 0;
    check_refused(&network, &conditions, "/throats/radius: row 9");
    network.throat_kind[9] = THROAT_IMPOSED_EMPTY; // it takes no part now
    struct drying_history history = dry_and_check(&network, &conditions);
    drying_history_free(&history);

    network.packing.periodic[2] = 1;
    check_refused(&network, &conditions, "/domain/periodic");
    network.packing.periodic[2] = 0;
    struct drying_conditions without = conditions;
    without.feet = FEET_AUXILIARY;
    check_refused(&network, &without, "/throats/kind: no throat of the boundary layer");
    for (int t = 0; t < network.n_throat; t++)
        network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
    check_refused(&network, &conditions, "/throats/kind");
    network.throat_kind[0] = THROAT_NETWORK; // at the bottom
    check_refused(&network, &conditions, "no throat reaches the open wall");
    network_free(&network);
}

TEST(liquid_without_a_way_out)
{
    struct network network = lattice_network(3, 3, 4, spacing);
    for (int t = 0; t < network.n_throat; t++)
        if (network.throat_nodes[t][0] / 9 == 1 && network.throat_nodes[t][1] / 9 == 2)
            network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
    for (int liquid = LIQUID_INVISCID; liquid <= LIQUID_VISCOUS; liquid++) {
        const struct drying_conditions conditions =
            kharaghani_conditions((enum liquid_limit)liquid);
        check_refused(&network, &conditions, "/throats/nodes: row 0");
    }
    network_free(&network);
}

// From no boundary layer to speak of to one ten million times thicker than the network.
TEST(boundary_layers_of_any_thickness)
{
    struct network network = lattice_network(4, 4, 6, spacing);
    randomise_radii(&network, spacing, 0.2, 3);
    for (int liquid = LIQUID_INVISCID; liquid <= LIQUID_IMMOBILE; liquid++)
        for (int power = -6; power <= 12; power++) {
            struct drying_conditions conditions =
                kharaghani_conditions((enum liquid_limit)liquid);
            conditions.mass_transfer = pow(10, power);
            conditions.layers = 5;
            struct drying_history history = dry_and_check(&network, &conditions);
            drying_history_free(&history);
        }
    network_free(&network);
}
