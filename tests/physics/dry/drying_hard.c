// SPDX-License-Identifier: GPL-3.0-or-later
// Networks that try the arithmetic: nothing but ties, radii over six decades, one
// throat, vapour near boiling; and steps that are recorded now and then only.
#include "../../test.h"
#include "../support_lattice.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const double spacing = 5e-7;

TEST(equal_radii_in_a_stated_order)
{
    struct network network = lattice_network(5, 5, 5, spacing);
    for (int liquid = LIQUID_INVISCID; liquid <= LIQUID_VISCOUS; liquid++) {
        const struct drying_conditions conditions =
            kharaghani_conditions((enum liquid_limit)liquid);
        struct drying_history history = dry_and_check(&network, &conditions);
        struct drying_history again = dry_and_check(&network, &conditions);
        for (int k = 1; k < history.n_event; k++)
            if (history.event_time[k] == history.event_time[k - 1])
                assert_true(history.event_throat[k] > history.event_throat[k - 1]);
        assert_memory_equal(history.event_throat, again.event_throat,
                            (size_t)history.n_event * sizeof *history.event_throat);
        drying_history_free(&history);
        drying_history_free(&again);
    }
    network_free(&network);
}

// The least throats hold 1e-12 of what the widest do: they empty within the last digit
// of the time.
TEST(radii_over_six_decades)
{
    struct network network = lattice_network(6, 6, 6, spacing);
    uint64_t seed = 8;
    for (int t = 0; t < network.n_throat; t++)
        network.throat_radius[t] = spacing * pow(10, -6 * next_random(&seed));
    for (int liquid = LIQUID_INVISCID; liquid <= LIQUID_IMMOBILE; liquid++) {
        const struct drying_conditions conditions =
            kharaghani_conditions((enum liquid_limit)liquid);
        struct drying_history history;
        struct reason reason;
        assert_int_equal(dry_network(&network, &conditions, NULL, &history, &reason),
                         0);
        assert_int_equal(history.n_event, network.n_throat);
        assert_true(fabs(history.evaporated / history.initial_liquid - 1) < 1e-12);
        assert_true(history.vapour_residual < 1e-12);
        for (int k = 1; k < history.n_step; k++) {
            assert_true(history.time[k] >= history.time[k - 1]);
            assert_true(history.rate[k] <= history.rate[k - 1] * (1 + 1e-12));
            assert_true(history.saturation[k] >= 0);
            assert_true(history.saturation[k] <= history.saturation[k - 1]);
        }
        drying_history_free(&history);
    }
    network_free(&network);
}

TEST(one_throat_near_boiling)
{
    struct network network = lattice_network(2, 2, 2, spacing);
    const int throat = lattice_throat(&network, 0, 2);
    for (int t = 0; t < network.n_throat; t++)
        if (t != throat) network.throat_kind[t] = THROAT_IMPOSED_EMPTY;
    for (int liquid = LIQUID_INVISCID; liquid <= LIQUID_VISCOUS; liquid++) {
        struct drying_conditions conditions =
            kharaghani_conditions((enum liquid_limit)liquid);
        conditions.saturation_pressure = conditions.gas_pressure * (1 - 1e-9);
        struct drying_history history = dry_and_check(&network, &conditions);
        assert_int_equal(history.n_step, 2);
        assert_int_equal(history.event_throat[0], throat);
        drying_history_free(&history);
    }
    network_free(&network);
}

// All is as at room temperature, but faster by the potential, which near boiling goes
// with the logarithm of what is left to p_g. Viscous liquid is made thinner by as much.
TEST(networks_near_boiling)
{
    struct network network = lattice_network(5, 5, 5, spacing);
    randomise_radii(&network, spacing, 0.3, 5);
    for (int liquid = LIQUID_INVISCID; liquid <= LIQUID_VISCOUS; liquid++) {
        struct drying_conditions conditions =
            kharaghani_conditions((enum liquid_limit)liquid);
        conditions.viscosity = 1e-6;
        struct drying_history cold = dry_and_check(&network, &conditions);
        for (double left = 1e-3; left > 1e-10; left *= 1e-2) {
            conditions.saturation_pressure = conditions.gas_pressure * (1 - left);
            const double over =
                (conditions.gas_pressure - conditions.saturation_pressure) /
                conditions.gas_pressure; // LEFT as the numbers have it
            const double faster = log(1 / over) / log(1e5 / (1e5 - 2339));
            conditions.viscosity = 1e-6 / faster;
            struct drying_history hot = dry_and_check(&network, &conditions);
            for (int k = 0; k < cold.n_event; k++) {
                assert_int_equal(hot.event_throat[k], cold.event_throat[k]);
                assert_true(fabs(hot.event_time[k] * faster / cold.event_time[k] - 1) <
                            1e-11);
            }
            drying_history_free(&hot);
        }
        drying_history_free(&cold);
    }
    network_free(&network);
}

// The same events at the same moments; between recorded steps the rate is the mean.
TEST(recording_less_changes_nothing)
{
    struct network network = lattice_network(7, 7, 7, spacing);
    randomise_radii(&network, spacing, 0.3, 4);
    for (int liquid = LIQUID_INVISCID; liquid <= LIQUID_VISCOUS; liquid++) {
        struct drying_conditions conditions =
            kharaghani_conditions((enum liquid_limit)liquid);
        struct drying_history all = dry_and_check(&network, &conditions);
        conditions.step_interval = 0.05;
        struct drying_history few;
        struct reason reason;
        assert_int_equal(dry_network(&network, &conditions, NULL, &few, &reason), 0);
        assert_int_equal(few.n_event, all.n_event);
        assert_memory_equal(few.event_throat, all.event_throat,
                            (size_t)all.n_event * sizeof *all.event_throat);
        assert_memory_equal(few.event_time, all.event_time,
                            (size_t)all.n_event * sizeof *all.event_time);
        assert_true(few.n_step <= 21);
        double evaporated = 0;
        for (int k = 0; k + 1 < few.n_step; k++)
            evaporated += few.rate[k] * (few.time[k + 1] - few.time[k]);
        assert_true(fabs(evaporated / few.initial_liquid - 1) < 1e-13);
        assert_true(few.first_period_end_saturation == all.first_period_end_saturation);
        drying_history_free(&all);
        drying_history_free(&few);
    }
    network_free(&network);
}

// What changed at each event of a large network would fill the memory.
TEST(large_networks_are_not_recorded_whole)
{
    struct network network = lattice_network(36, 36, 36, spacing);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    struct drying_history history;
    struct reason reason = {""};
    assert_int_equal(dry_network(&network, &conditions, NULL, &history, &reason),
                     STATUS_BAD_DATA);
    assert_non_null(strstr(reason.text, "step_interval: must be above 0"));
    drying_history_free(&history);
    network_free(&network);
}
