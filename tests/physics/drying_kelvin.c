// SPDX-License-Identifier: GPL-3.0-or-later
// Menisci with vapour pressures of their own: tubes in closed form, condensation in
// balance, and the limit of no surface tension.
#include "support_lattice.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double spacing = 1e-7;

static struct drying_conditions kelvin_conditions(void)
{
    struct drying_conditions conditions = kharaghani_conditions(LIQUID_IMMOBILE);
    conditions.kelvin = true;
    return conditions;
}

// kg/s through a unit of area over length, from a meniscus of that radius into the air.
static double drive(const struct drying_conditions *conditions, double radius)
{
    const double tension =
        2 * conditions->surface_tension * cos(conditions->contact_angle * (M_PI / 180));
    const double gas = conditions->gas_pressure, heat = GAS_CONSTANT * 293.15;
    const double vapour = conditions->saturation_pressure *
                          exp(-tension / radius * conditions->molar_mass /
                              (conditions->liquid_density * heat));
    return conditions->diffusivity * gas * conditions->molar_mass / heat *
           log((gas - conditions->air_vapour_pressure) / (gas - vapour));
}

// Leaves only the columns along z at those nodes of the bottom that are in COLUMNS.
static void leave_columns(struct network *network, unsigned columns)
{
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *node = network->throat_nodes[t];
        if (node[1] - node[0] != 4 || !(columns >> node[0] % 4 & 1))
            network->throat_kind[t] = THROAT_IMPOSED_EMPTY;
    }
}

// Two tubes in series, the wide one above: each has its own vapour while it empties.
static void test_tubes_in_series(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        struct network network = lattice_network(2, 2, 3, spacing);
        leave_columns(&network, 1);
        const int lower = lattice_throat(&network, 0, 2);
        const int upper = lattice_throat(&network, 4, 2);
        network.throat_radius[lower] = 3e-9;
        network.throat_radius[upper] = k < 2 ? 2e-8 : 2e-9;
        struct drying_conditions conditions = kelvin_conditions();
        conditions.contact_angle = k % 2 ? 60 : 0;
        conditions.air_vapour_pressure = 300;
        struct drying_history history = dry_and_check(&network, &conditions);
        const double layer =
            conditions.diffusivity / conditions.mass_transfer / (spacing * spacing);
        const double r = network.throat_radius[upper];
        const double first = drive(&conditions, r) / layer;
        const double second =
            drive(&conditions, 3e-9) / (layer + spacing / (M_PI * r * r));
        assert_true(fabs(history.rate[0] / first - 1) < 1e-12);
        assert_true(fabs(history.rate[1] / second - 1) < 1e-12);
        const double time = spacing * M_PI * conditions.liquid_density *
                            (r * r / first + 9e-18 / second);
        assert_true(fabs(history.time[2] / time - 1) < 1e-12);
        drying_history_free(&history);
        network_free(&network);
    }
}

// Side by side, each through a layer of its own.
static void test_tubes_in_parallel(void **state)
{
    (void)state;
    struct network network = lattice_network(2, 2, 2, spacing);
    leave_columns(&network, 15);
    struct drying_conditions conditions = kelvin_conditions();
    conditions.lumped = true;
    double rate = 0;
    for (int t = 0, k = 0; t < network.n_throat; t++) {
        if (network.throat_kind[t] != THROAT_NETWORK) continue;
        network.throat_radius[t] = 2e-9 * (1 << k++);
        const double quarter = spacing * spacing / 4;
        rate += drive(&conditions, network.throat_radius[t]) * quarter /
                (conditions.diffusivity / conditions.mass_transfer);
    }
    struct drying_history history = dry_and_check(&network, &conditions);
    assert_true(fabs(history.rate[0] / rate - 1) < 1e-12);
    drying_history_free(&history);
    network_free(&network);
}

// Radii from 2 to 38 nm in a random order: vapour condenses. Nothing is lost, above 1
// or below 0, and what has filled again empties again.
static void test_condensation_balances(void **state)
{
    (void)state;
    struct network network = lattice_network(5, 5, 6, spacing);
    randomise_radii(&network, spacing, 0.9, 12);
    const struct drying_conditions conditions = kelvin_conditions();
    struct drying_history history;
    struct reason reason = {""};
    if (dry_network(&network, &conditions, NULL, &history, &reason))
        fail_msg("%s", reason.text);
    assert_true(fabs(history.evaporated / history.initial_liquid - 1) < 1e-12);
    assert_true(history.vapour_residual < 1e-9);
    assert_true(history.saturation[history.n_step - 1] == 0);
    int refilled = 0;
    for (int k = 0; k < history.n_event; k++)
        refilled += history.event_kind[k] == EVENT_REFILLED;
    assert_true(refilled > 0);
    assert_int_equal(history.n_event, network.n_throat + refilled);
    for (int64_t c = 0; c < history.change_offset[history.n_step]; c++)
        assert_true(history.change_saturation[c] >= 0 &&
                    history.change_saturation[c] <= 1);
    for (int k = 0; k + 1 < history.n_step; k++)
        assert_true(history.time[k + 1] >= history.time[k]);
    drying_history_free(&history);
    network_free(&network);
}

// As the surface tension goes to 0, all is as without.
static void test_no_tension_is_no_effect(void **state)
{
    (void)state;
    struct network network = lattice_network(5, 5, 6, spacing);
    randomise_radii(&network, spacing, 0.5, 13);
    struct drying_conditions conditions = kelvin_conditions();
    conditions.surface_tension = 1e-12;
    struct drying_history with = dry_and_check(&network, &conditions);
    conditions.kelvin = false;
    struct drying_history without = dry_and_check(&network, &conditions);
    assert_int_equal(with.n_event, without.n_event);
    const double end = without.time[without.n_step - 1];
    for (int k = 0; k < with.n_event; k++) {
        assert_int_equal(with.event_throat[k], without.event_throat[k]);
        assert_true(fabs(with.event_time[k] - without.event_time[k]) < 1e-9 * end);
    }
    drying_history_free(&with);
    drying_history_free(&without);
    network_free(&network);
}

static void test_refusals(void **state)
{
    (void)state;
    struct network network = lattice_network(3, 3, 3, spacing);
    struct drying_conditions conditions = kelvin_conditions();
    const struct {
        double air;
        enum liquid_limit liquid;
        const char *says;
    } wrong[] = {{0.99 * 2339, LIQUID_IMMOBILE, "never dries"}, // 0.95 in the throats
                 {0, LIQUID_INVISCID, "kelvin: must be false"},
                 {0, LIQUID_VISCOUS, "kelvin: must be false"}};
    for (int k = 0; k < 3; k++) {
        conditions.air_vapour_pressure = wrong[k].air;
        conditions.liquid = wrong[k].liquid;
        struct drying_history history;
        struct reason reason = {""};
        assert_int_equal(dry_network(&network, &conditions, NULL, &history, &reason),
                         STATUS_BAD_DATA);
        assert_non_null(strstr(reason.text, wrong[k].says));
        drying_history_free(&history);
    }
    network_free(&network);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_tubes_in_series),
                                       cmocka_unit_test(test_tubes_in_parallel),
                                       cmocka_unit_test(test_condensation_balances),
                                       cmocka_unit_test(test_no_tension_is_no_effect),
                                       cmocka_unit_test(test_refusals)};
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
