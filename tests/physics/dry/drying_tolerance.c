// SPDX-License-Identifier: GPL-3.0-or-later
// Drying with vapour_tolerance beside the exact vapour of the same throats and nodes,
// event by event: what wet nodes give off, errors added up, and the rate.
#include "../../test.h"
#include "../support_lattice.h"
#include "dry/conditions.h"
#include "dry/gas/boundary_layer.h"
#include "dry/inviscid/emptying_times.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

static const double spacing = 5e-7;

struct errors {
    double sum, rate; // largest, of the exact rate
};

static void compare(const struct occupancy *occupancy, const struct vapour *exact,
                    struct errors *errors)
{
    const struct vapour *vapour = &occupancy->vapour;
    const double rate = vapour_rate(exact);
    double sum = 0;
    for (int k = 0; k < occupancy->n_wet; k++) {
        const int node = occupancy->wet[k];
        const double given_off = vapour_evaporation(vapour, node);
        const double truth = vapour_evaporation(exact, node);
        assert_true(given_off >= 0 && (truth > 0 || given_off == 0));
        sum += fabs(given_off - truth);
    }
    errors->sum = fmax(errors->sum, sum / rate);
    errors->rate = fmax(errors->rate, fabs(vapour_rate(vapour) / rate - 1));
}

static void empty_exactly(const struct occupancy *occupancy, struct vapour *exact,
                          int throat, int *liquid_beside)
{
    const int32_t *node = occupancy->network->throat_nodes[throat];
    vapour_open_throat(exact, throat, node[0], node[1]);
    for (int end = 0; end < 2; end++)
        if (--liquid_beside[node[end]] == 0) vapour_dry_node(exact, node[end]);
}

static struct errors dry_beside_exact(const struct network *network,
                                      const struct drying_conditions *conditions)
{
    const struct drying_scale scale = drying_scale(network, conditions);
    const struct occupancy_form form = {
        .length = scale.length,
        .gas_parts = conditions->liquid != LIQUID_IMMOBILE,
        .vapour_tolerance = conditions->vapour_tolerance};
    struct boundary_layer layer;
    struct occupancy occupancy;
    struct reason reason;
    assert_int_equal(boundary_layers_init(network, conditions->open_walls, scale.length,
                                          scale.boundary_layer,
                                          &(struct boundary_form){conditions->feet,
                                                                  conditions->layers,
                                                                  conditions->lumped},
                                          &layer, &reason),
                     STATUS_OK);
    assert_int_equal(occupancy_init(network, conditions->open_walls, &form, layer,
                                    &occupancy, &reason),
                     STATUS_OK);
    struct vapour exact = vapour_init(network, scale.length, 0, &occupancy.layer, 0, 0);
    int *liquid_beside = duplicate(occupancy.liquid_beside, (size_t)network->n_node,
                                   sizeof *liquid_beside);
    struct emptying_times times =
        emptying_times_init(&occupancy, conditions->liquid == LIQUID_IMMOBILE);
    struct errors errors = {0};
    compare(&occupancy, &exact, &errors);
    while (occupancy.n_liquid > 0) {
        assert_true(emptying_times_advance(&times) >= 0);
        for (int k = 0; k < times.n_ended; k++)
            empty_exactly(&occupancy, &exact, times.ended[k], liquid_beside);
        emptying_times_empty_ended(&times);
        if (occupancy.n_liquid > 0) compare(&occupancy, &exact, &errors);
        assert_true(fabs(emptying_times_imbalance(&times)) < 1e-12);
    }
    emptying_times_free(&times);
    free(liquid_beside);
    vapour_free(&exact);
    occupancy_free(&occupancy);
    return errors;
}

static void check_tolerance(const struct network *network,
                            struct drying_conditions conditions)
{
    conditions.vapour_tolerance = 1e-6;
    const struct errors errors = dry_beside_exact(network, &conditions);
    print_message("# errors %.2g of the rate, of it %.2g\n", errors.sum, errors.rate);
    assert_true(errors.sum > 0); // links are indeed rounded
    assert_true(errors.sum <= conditions.vapour_tolerance);
    assert_true(errors.rate <= conditions.vapour_tolerance);
}

TEST(errors_are_below_the_tolerance)
{
    struct network network = lattice_network(20, 18, 6, spacing);
    randomise_radii(&network, spacing, 0.5, 3);
    for (int liquid = LIQUID_INVISCID; liquid <= LIQUID_IMMOBILE; liquid++) {
        struct drying_conditions conditions =
            kharaghani_conditions((enum liquid_limit)liquid);
        check_tolerance(&network, conditions);
        conditions.lumped = true;
        check_tolerance(&network, conditions);
    }
    network_free(&network);
}

TEST(conductances_over_twelve_decades)
{
    struct network network = lattice_network(15, 14, 4, spacing);
    uint64_t seed = 12;
    for (int t = 0; t < network.n_throat; t++)
        network.throat_radius[t] = spacing * pow(10, -6 * next_random(&seed));
    check_tolerance(&network, kharaghani_conditions(LIQUID_IMMOBILE));
    network_free(&network);
}

// Through the whole run: the balances that dry_and_check asks for, and times near the
// exact ones.
TEST(whole_runs)
{
    struct network network = lattice_network(16, 15, 5, spacing);
    randomise_radii(&network, spacing, 0.5, 4);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    struct drying_history exact = dry_and_check(&network, &conditions);
    conditions.vapour_tolerance = 1e-6;
    struct drying_history history = dry_and_check(&network, &conditions);
    struct drying_history again = dry_and_check(&network, &conditions);
    assert_int_equal(history.n_step, again.n_step);
    assert_memory_equal(history.time, again.time,
                        (size_t)history.n_step * sizeof *history.time);
    const double end = exact.time[exact.n_step - 1];
    assert_true(fabs(history.time[history.n_step - 1] / end - 1) < 1e-6);
    drying_history_free(&exact);
    drying_history_free(&history);
    drying_history_free(&again);
    network_free(&network);
}
