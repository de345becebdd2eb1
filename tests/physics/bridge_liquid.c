// SPDX-License-Identifier: GPL-3.0-or-later
// Bridges between many grains: formed by touch, kept until rupture, their liquid
// shared.
#include "bridges/liquid.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const double radius[2] = {1e-3, 5e-4};

static struct liquid some_liquid(enum liquid_sharing sharing, int n_grain)
{
    const struct liquid like = {.sharing = sharing,
                                .model = BRIDGE_WILLETT_FULL,
                                .surface_tension = 0.07,
                                .contact_angle = 0.2,
                                .volume = 1e-12};
    return liquid_create(&like, n_grain);
}

static void test_forms_by_touch_and_lasts_till_rupture(void **state)
{
    (void)state;
    struct liquid liquid = some_liquid(LIQUID_FIXED, 2);
    const struct bridge bridge = {{1e-3, 5e-4}, {0.2, 0.2}, 0.07, 1e-12};
    const double rupture = bridge_rupture_distance(&bridge);
    bool bridged = false;
    for (double a = 2 * rupture; a > 0; a -= 0.01 * rupture) {
        bridged = liquid_bridged(&liquid, 0, 1, radius, a, bridged);
        assert_false(bridged);
    }
    bridged = liquid_bridged(&liquid, 0, 1, radius, -1e-9, bridged);
    assert_true(bridged);
    assert_true(liquid_force(&liquid, 0, 1, radius, -1e-9) <= 0); // [G 4]
    liquid.pulls_in_contact = true;
    assert_true(liquid_force(&liquid, 0, 1, radius, -1e-9) > 0);
    for (double a = 0; a < 2 * rupture; a += 0.01 * rupture) {
        bridged = liquid_bridged(&liquid, 0, 1, radius, a, bridged);
        assert_true(bridged == (a <= rupture));
        if (bridged) assert_true(liquid_force(&liquid, 0, 1, radius, a) > 0);
    }
    assert_int_equal(liquid.bridges[0], 0);
    liquid_free(&liquid);
}

// Whatever bridges come and go, those of wet grains hold all their liquid.
static void test_shared_liquid_is_conserved(void **state)
{
    (void)state;
    enum { GRAINS = 6 };
    struct liquid liquid = some_liquid(LIQUID_SHARED, GRAINS);
    bool bridged[GRAINS][GRAINS] = {{false}};
    unsigned random = 1;
    for (int step = 0; step < 200; step++) {
        for (int i = 0; i < GRAINS; i++)
            for (int j = i + 1; j < GRAINS; j++) {
                random = random * 1664525 + 1013904223;
                const double a = ((random >> 16 & 255) - 100.0) * 1e-6;
                bridged[i][j] = liquid_bridged(&liquid, i, j, radius, a, bridged[i][j]);
            }
        double held = 0, there = 0;
        for (int i = 0; i < GRAINS; i++) {
            there += liquid.bridges[i] > 0 ? liquid.volume : 0;
            for (int j = i + 1; j < GRAINS; j++)
                held += bridged[i][j] ? liquid_volume(&liquid, i, j) : 0;
        }
        assert_true(fabs(held - there) <= 1e-12 * liquid.volume);
    }
    liquid_free(&liquid);
}

int main(void)
{
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_forms_by_touch_and_lasts_till_rupture),
        cmocka_unit_test(test_shared_liquid_is_conserved)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
