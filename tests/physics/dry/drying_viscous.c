// SPDX-License-Identifier: GPL-3.0-or-later
// Viscous liquid between its menisci [K 3.10]: two tubes in closed form, and both
// limits.
#include "../../test.h"
#include "../support_lattice.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

static const double spacing = 5e-7;
enum { DEPTH = 6 };

// Two tubes from the surface, over columns 0 and 1 of the lattice, joined at the
// bottom. The second is narrower by RATIO.
static struct network two_tubes(double ratio)
{
    struct network network = lattice_network(2, 2, DEPTH + 1, spacing);
    for (int t = 0; t < network.n_throat; t++) {
        const int32_t *node = network.throat_nodes[t];
        const bool tube = node[1] - node[0] == 4 && node[0] % 4 < 2;
        const bool bridge = node[0] == 0 && node[1] == 1;
        if (!tube && !bridge) network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
        if (node[0] % 4 == 1) network.throat_radius[t] *= ratio;
    }
    return network;
}

static double resistance(const struct network *network, int throat, double viscosity)
{
    const double r = network->throat_radius[throat];
    return 8 * viscosity * network->throat_length[throat] / (M_PI * r * r * r * r);
}

// All the liquid's way from one meniscus to the other, Pa s / kg.
static double total_resistance(const struct network *network, double viscosity)
{
    double sum = 0;
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK)
            sum += resistance(network, t, viscosity);
    return sum;
}

// Mass a throat loses in the first step.
static double first_loss(const struct network *network,
                         const struct drying_history *history, int throat)
{
    for (int64_t c = history->change_offset[1]; c < history->change_offset[2]; c++)
        if (history->change_throat[c] == throat)
            return (1 - history->change_saturation[c]) *
                   throat_volume(network, throat) * 998.2;
    return 0;
}

// The narrow tube's meniscus stays as long as the difference of capillary pressures
// drives through all the throats what evaporates from it; beyond, it recedes at the
// rest.
TEST(two_tubes)
{
    struct network network = two_tubes(0.8);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_VISCOUS);
    const int wide = lattice_throat(&network, 4 * (DEPTH - 1), 2);
    const int narrow = lattice_throat(&network, 4 * (DEPTH - 1) + 1, 2);
    const double suction = 2 * 0.07274 / network.throat_radius[narrow] -
                           2 * 0.07274 / network.throat_radius[wide];
    struct drying_history history = dry_and_check(&network, &conditions);
    const double evaporation = history.rate[0] / 2; // of either tube
    drying_history_free(&history);
    const double critical = suction / (evaporation * total_resistance(&network, 1));
    const double factors[] = {1e-9, 0.5, 0.999, 1.001, 2, 1e9};
    for (int k = 0; k < 6; k++) {
        conditions.viscosity = factors[k] * critical;
        history = dry_and_check(&network, &conditions);
        const double flow = fmin(
            evaporation, suction / total_resistance(&network, conditions.viscosity));
        const double time = history.time[1];
        const double loss = first_loss(&network, &history, narrow);
        assert_int_equal(history.event_throat[0], k < 5 ? wide : narrow);
        assert_true(fabs(first_loss(&network, &history, wide) / time -
                         (evaporation + flow)) < 1e-11 * evaporation);
        assert_true(fabs(loss / time - (evaporation - flow)) < 1e-11 * evaporation);
        assert_int_equal(loss > 0, factors[k] > 1);
        drying_history_free(&history);
    }
    network_free(&network);
}

// While only the wide tube's meniscus moves, pressure falls from it to the narrow one
// by what evaporates there times the resistances passed.
TEST(pressures_along_a_chain)
{
    struct network network = two_tubes(0.8);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_VISCOUS);
    const double full = 1;
    conditions.snapshot = &full;
    conditions.n_snapshot = 1;
    struct drying_history history = dry_and_check(&network, &conditions);
    assert_int_equal(history.n_pressure, 1);
    const int top = 4 * (DEPTH - 1);
    const double evaporation = history.rate[0] / 2;
    double pressure =
        -2 * 0.07274 / network.throat_radius[lattice_throat(&network, top, 2)];
    for (int k = DEPTH - 1; k >= 0; k--) { // down the wide tube
        const int throat = lattice_throat(&network, 4 * k, 2);
        pressure -= evaporation * resistance(&network, throat, conditions.viscosity);
        assert_true(fabs(history.pressure[4 * k] / pressure - 1) < 1e-13);
    }
    for (int k = 0; k < DEPTH; k++) { // across, and up the narrow one
        const int throat = k == 0 ? lattice_throat(&network, 0, 0)
                                  : lattice_throat(&network, 4 * (k - 1) + 1, 2);
        pressure -= evaporation * resistance(&network, throat, conditions.viscosity);
        assert_true(fabs(history.pressure[4 * k + 1] / pressure - 1) < 1e-13);
    }
    drying_history_free(&history);
    network_free(&network);
}

// Under a throat that keeps all vapour in, a wide meniscus recedes and a narrow throat
// that is half empty refills from it: the difference of their capillary pressures
// drives the flow through both, the narrow one as short as its liquid.
TEST(refills_where_nothing_evaporates)
{
    struct network network = lattice_column(5, spacing);
    int throat[5]; // from the bottom: empty, wide, narrow and half full, empty, full
    for (int k = 0; k < 5; k++)
        throat[k] = lattice_throat(&network, 4 * k, 2);
    network.throat_radius[throat[2]] *= 0.8;
    double *start = NEW_ARRAY(double, network.n_throat);
    start[throat[1]] = start[throat[4]] = 1;
    start[throat[2]] = 0.5;
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_VISCOUS);
    conditions.start = start;
    const double full = 1;
    conditions.snapshot = &full;
    conditions.n_snapshot = 1;
    struct drying_history history = dry_or_fail(&network, &conditions);
    const double entry[] = {-2 * 0.07274 / network.throat_radius[throat[1]],
                            -2 * 0.07274 / network.throat_radius[throat[2]]};
    const double wide = resistance(&network, throat[1], conditions.viscosity);
    const double narrow = resistance(&network, throat[2], conditions.viscosity) / 2;
    const double flow = (entry[0] - entry[1]) / (wide + narrow);
    const double missing = 998.2 * throat_volume(&network, throat[2]) / 2;
    assert_int_equal(history.event_throat[0], throat[2]);
    assert_int_equal(history.event_kind[0], EVENT_REFILLED);
    assert_true(fabs(history.event_time[0] * flow / missing - 1) < 1e-11);
    assert_true(fabs(history.pressure[8] / (entry[0] - flow * wide) - 1) < 1e-12);
    drying_history_free(&history);
    free(start);
    network_free(&network);
}

// As conductances are renewed more often, the time at which the first throat has
// emptied goes to a limit with the first power of the step.
TEST(step_converges)
{
    struct network network = two_tubes(0.8);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_VISCOUS);
    conditions.viscosity = 3e-3;
    double saturation[5];
    for (int k = 0; k < 5; k++) {
        conditions.saturation_step = 1 / pow(2, k + 2);
        struct drying_history history;
        struct reason reason;
        assert_int_equal(dry_network(&network, &conditions, NULL, &history, &reason),
                         STATUS_OK);
        int step = 0;
        while (history.time[step] < history.event_time[0])
            step++;
        saturation[k] = history.saturation[step];
        assert_true(fabs(history.evaporated / history.initial_liquid - 1) < 1e-12);
        drying_history_free(&history);
    }
    for (int k = 0; k < 3; k++) {
        const double ratio = (saturation[k] - saturation[k + 1]) /
                             (saturation[k + 1] - saturation[k + 2]);
        assert_true(ratio > 1.6 && ratio < 2.5);
    }
    network_free(&network);
}

// Order of emptying; the times to TOLERANCE.
static void check_limit(enum liquid_limit limit, double viscosity, double tolerance)
{
    struct network network = lattice_network(6, 5, 6, spacing);
    randomise_radii(&network, spacing, 0.3, 11);
    struct drying_conditions conditions = kharaghani_conditions(limit);
    struct drying_history expected = dry_and_check(&network, &conditions);
    conditions.liquid = LIQUID_VISCOUS;
    conditions.viscosity = viscosity;
    struct drying_history history = dry_and_check(&network, &conditions);
    int n = 0;
    for (int k = 0; k < history.n_event; k++) {
        if (history.event_kind[k] == EVENT_REFILLED) continue;
        assert_int_equal(history.event_throat[k], expected.event_throat[n]);

        assert_true(fabs(history.event_time[k] / expected.event_time[n] - 1) <
                    tolerance);
        n++;
    }
    assert_int_equal(n, expected.n_event);
    drying_history_free(&expected);
    drying_history_free(&history);
    network_free(&network);
}

TEST(vanishing_viscosity_is_inviscid)
{
    check_limit(LIQUID_INVISCID, 1e-18, 1e-12);
}

TEST(great_viscosity_is_immobile)
{
    // At a million times that of water, flow is still a hundredth of evaporation.
    check_limit(LIQUID_IMMOBILE, 1e4, 1e-5);
    check_limit(LIQUID_IMMOBILE, 1e7, 1e-8);
}

// All throats equal: menisci that are alike exchange nothing, and all dries.
TEST(equal_throats)
{
    struct network network = lattice_network(5, 5, 5, spacing);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_VISCOUS);
    for (int k = -18; k <= 0; k += 6) {
        conditions.viscosity = pow(10, k);
        struct drying_history history = dry_and_check(&network, &conditions);
        drying_history_free(&history);
    }
    network_free(&network);
}

// Between them, decade by decade, everything balances, and throats refill.
TEST(eighteen_decades)
{
    struct network network = lattice_network(4, 4, 6, spacing);
    randomise_radii(&network, spacing, 0.5, 5);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_VISCOUS);
    int n_refill = 0;
    for (int k = -18; k <= 0; k++) {
        conditions.viscosity = pow(10, k);
        struct drying_history history = dry_and_check(&network, &conditions);
        assert_true(history.liquid_residual < 1e-12);
        for (int e = 0; e < history.n_event; e++)
            n_refill += history.event_kind[e] == EVENT_REFILLED;
        drying_history_free(&history);
    }
    assert_true(n_refill > 0);
    network_free(&network);
}

// Pieces of one throat each have nothing to flow to: viscosity changes nothing, over
// twelve decades.
TEST(throats_alone)
{
    struct network network = lattice_network(3, 3, 2, spacing);
    randomise_radii(&network, spacing, 0.3, 4);
    for (int t = 0; t < network.n_throat; t++)
        if (network.throat_nodes[t][1] - network.throat_nodes[t][0] != 9)
            network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    struct drying_history expected = dry_and_check(&network, &conditions);
    conditions.liquid = LIQUID_VISCOUS;
    for (int k = -12; k <= 0; k += 3) {
        conditions.viscosity = pow(10, k);
        struct drying_history history = dry_and_check(&network, &conditions);
        assert_int_equal(history.n_event, expected.n_event);
        for (int e = 0; e < history.n_event; e++) {
            assert_int_equal(history.event_throat[e], expected.event_throat[e]);
            assert_true(fabs(history.event_time[e] / expected.event_time[e] - 1) <
                        1e-13);
        }
        drying_history_free(&history);
    }
    drying_history_free(&expected);
    network_free(&network);
}

// Radii over six decades, conductances over twenty-four: balances close all the same.
// Times do not all differ, as volumes are over twelve decades.
TEST(radii_over_six_decades)
{
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct network network = lattice_network(6, 6, 6, spacing);
        uint64_t random = seed;
        for (int t = 0; t < network.n_throat; t++)
            network.throat_radius[t] =
                0.3 * spacing * pow(10, -6 * next_random(&random));
        struct drying_conditions conditions = kharaghani_conditions(LIQUID_VISCOUS);
        for (int k = -14; k <= -2; k += 4) {
            conditions.viscosity = pow(10, k);
            struct drying_history history;
            struct reason reason = {""};
            if (dry_network(&network, &conditions, NULL, &history, &reason))
                fail_msg("%s", reason.text);
            assert_true(history.liquid_residual < 1e-12);
            assert_true(fabs(history.evaporated / history.initial_liquid - 1) < 1e-12);
            assert_true(history.saturation[history.n_step - 1] == 0);
            drying_history_free(&history);
        }
        network_free(&network);
    }
}
