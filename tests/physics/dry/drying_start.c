// SPDX-License-Identifier: GPL-3.0-or-later
// Networks that do not begin full: on from the middle of another run they dry as it
// did; gas that has come in by itself has taken the throats that invasion percolation
// takes; a tube half empty is a shorter tube under a longer way out.
#include "../../test.h"
#include "../support_lattice.h"

#include "basics/memory.h"
#include "dry/run/initial_saturation.h"
#include "network/invasion.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const double spacing = 1e-6;

static struct drying_history dry_from(const struct network *network,
                                      const struct drying_conditions *conditions,
                                      const double *start)
{
    struct drying_conditions from = *conditions;
    from.start = start;
    struct drying_history history = dry_or_fail(network, &from);
    assert_true(fabs(history.evaporated / history.initial_liquid - 1) < 1e-12);
    assert_true(history.vapour_residual < 1e-12);
    assert_true(history.saturation[history.n_step - 1] == 0);
    return history;
}

static double liquid_in(const struct network *network, const double *saturation)
{
    double liquid = 0, full = 0;
    for (int t = 0; t < network->n_throat; t++) {
        liquid += saturation[t] * throat_volume(network, t);
        full += throat_volume(network, t);
    }
    return liquid / full;
}

// The events that are left come as they did, as much later as the moment was.
static void compare_rest(const struct drying_history *whole,
                         const struct drying_history *rest)
{
    const int skipped = whole->n_event - rest->n_event;
    assert_true(skipped > 0);
    const double later = whole->event_time[skipped] - rest->event_time[0];
    const double end = whole->time[whole->n_step - 1];
    for (int k = 0; k < rest->n_event; k++) {
        assert_int_equal(rest->event_throat[k], whole->event_throat[skipped + k]);
        assert_true(fabs(whole->event_time[skipped + k] - rest->event_time[k] - later) <
                    1e-12 * end);
    }
}

TEST(on_from_the_middle)
{
    struct network network = lattice_network(6, 6, 6, spacing);
    randomise_radii(&network, spacing, 0.3, 5);
    for (int limit = LIQUID_INVISCID; limit <= LIQUID_VISCOUS; limit++)
        for (double level = 0.9; level > 0.05; level -= 0.2) {
            const struct drying_conditions conditions =
                kharaghani_conditions((enum liquid_limit)limit);
            struct drying_history whole = dry_and_check(&network, &conditions);
            const struct drying_record record = {.n_step = whole.n_step,
                                                 .saturation = whole.saturation,
                                                 .offset = whole.change_offset,
                                                 .throat = whole.change_throat,
                                                 .throat_saturation =
                                                     whole.change_saturation};
            double *start = recorded_saturations(&network, &record, level);
            assert_true(fabs(liquid_in(&network, start) - level) < 1e-13);
            struct drying_history rest = dry_from(&network, &conditions, start);
            assert_true(fabs(rest.saturation[0] - level) < 1e-13);
            compare_rest(&whole, &rest);
            drying_history_free(&whole);
            drying_history_free(&rest);
            free(start);
        }
    network_free(&network);
}

// Liquid in NETWORK when gas has come in, of all.
static double rest_of_invasion(const struct network *network,
                               const struct invasion *invasion)
{
    double *left = NEW_ARRAY(double, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        left[t] = 1;
    for (int k = 0; k < invasion->n; k++)
        left[invasion->throat[k]] = 0;
    const double rest = liquid_in(network, left);
    free(left);
    return rest;
}

static void check_refused(const struct network *network,
                          const struct drying_conditions *conditions, const char *why)
{
    struct drying_history history;
    struct reason reason = {""};
    assert_int_equal(dry_network(network, conditions, NULL, &history, &reason),
                     STATUS_BAD_DATA);
    assert_non_null(strstr(reason.text, why));
    drying_history_free(&history);
}

// The throats that invade says, with trapping down to just above what it says is
// trapped, and no further.
static void check_gas_has_come_in(bool trapping)
{
    struct network network = lattice_network(8, 8, 8, spacing);
    randomise_radii(&network, spacing, 0.3, 6);
    struct invasion invasion;
    struct reason reason = {""};
    const struct invasion_conditions gas = {
        .inlet = WALL_Z_UPPER, .outlet = WALL_Z_LOWER, .trapping = trapping};
    assert_int_equal(invade(&network, &gas, &invasion, &reason), 0);
    const double rest = rest_of_invasion(&network, &invasion);
    const double saturation = trapping ? rest + 0.001 : 0.617;
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    conditions.start_saturation = saturation;
    conditions.start_trapping = trapping;
    struct drying_history history = dry_from(&network, &conditions, NULL);
    double *left = NEW_ARRAY(double, network.n_throat);
    for (int t = 0; t < network.n_throat; t++)
        left[t] = 1;
    const int64_t n_gone = history.change_offset[1];
    for (int64_t c = 0; c < n_gone; c++)
        left[history.change_throat[c]] = history.change_saturation[c];
    assert_true(fabs(liquid_in(&network, left) - saturation) < 1e-13);
    assert_true(fabs(history.saturation[0] - saturation) < 1e-13);
    for (int64_t k = 0; k + 1 < n_gone; k++)
        assert_true(left[invasion.throat[k]] == 0);
    const double last = left[invasion.throat[n_gone - 1]];
    assert_true(last >= 0 && last < 1);
    assert_int_equal(history.n_event, network.n_throat - n_gone + (last > 0));
    assert_true(trapping == (rest > 0.1));
    conditions.start_saturation = rest - 0.001;
    if (trapping) check_refused(&network, &conditions, "cuts off");
    conditions.open_walls |= WALL_Z_LOWER;
    if (trapping) check_refused(&network, &conditions, "opposite");
    free(left);
    invasion_free(&invasion);
    drying_history_free(&history);
    network_free(&network);
}

TEST(gas_has_come_in)
{
    check_gas_has_come_in(false);
    check_gas_has_come_in(true);
}

// One column of N throats, half of the third gone: the layer, two throats, and that is
// all that resists until the third is empty.
TEST(tube_half_empty)
{
    const int n = 6;
    struct network network = lattice_column(n, spacing);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    conditions.start_saturation = 3.5 / n;
    struct drying_history history = dry_from(&network, &conditions, NULL);
    const double r = 0.2 * spacing, section = M_PI * r * r;
    const double layer =
        conditions.diffusivity / conditions.mass_transfer / (spacing * spacing);
    const double drop =
        log(1 / (1 - 2339e-5)) * 1e5 * conditions.molar_mass / (GAS_CONSTANT * 293.15);
    assert_int_equal(history.n_event, 4);
    double time = 0;
    for (int k = 0; k < 4; k++) {
        const double resistance = layer + (2 + k) * spacing / section;
        const double rate = conditions.diffusivity * drop / resistance;
        assert_true(fabs(history.rate[k] / rate - 1) < 1e-12);
        time +=
            section * spacing * (k == 0 ? 0.5 : 1) * conditions.liquid_density / rate;
        assert_true(fabs(history.time[k + 1] / time - 1) < 1e-11);
    }
    drying_history_free(&history);
    network_free(&network);
}

TEST(more_than_full_is_refused)
{
    struct network network = lattice_network(2, 2, 2, spacing);
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_INVISCID);
    const double wrong[] = {0, -1, 1.5, NAN};
    for (int k = 0; k < 4; k++) {
        conditions.start_saturation = wrong[k];
        check_refused(&network, &conditions, "start_saturation");
    }
    network_free(&network);
}
