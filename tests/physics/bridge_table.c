// SPDX-License-Identifier: GPL-3.0-or-later
// The table of exact forces against the exact forces, off its nodes.
#include "../test.h"
#include "bridges/bridges.h"
#include "bridges/equilibrium.h"
#include "bridges/table.h"

#include <math.h>
#include <stdbool.h>

// Places in (0, 1) that fill it evenly.
static double place(int k, double irrational)
{
    return fmod(0.5 + k * irrational, 1);
}

// Of volumes and gaps inside the table and beyond.
static void check_ends(const struct bridge_table *table)
{
    enum { COUNT = 200 };
    double volume[COUNT], gap[COUNT], force[COUNT];
    for (int k = 0; k < COUNT; k++) {
        volume[k] = pow(10, -12 + 15 * place(k, 0.754877666));
        const double widest = bridge_table_rupture(table, volume[k]);
        gap[k] = widest * (2 * place(k, 0.569840290) - 0.5);
        const double at = bridge_table_force(table, volume[k], gap[k]);
        assert_true(isfinite(at));
        assert_true((at > 0) == (gap[k] < widest));
        if (gap[k] < 0) assert_true(at == bridge_table_force(table, volume[k], 0));
    }
    bridge_table_forces(table, COUNT, volume, gap, force);
    for (int k = 0; k < COUNT; k++)
        assert_true(fabs(force[k] - bridge_table_force(table, volume[k], gap[k])) <=
                    1e-12 * force[k]);
}

static void check_table(double other, double degrees, double tolerance)
{
    const double radius[2] = {1, other}, angle = degrees * M_PI / 180;
    const double angles[2] = {angle, angle}, scale = 2 / (1 + 1 / other);
    const struct bodies bodies = {{scale, scale / other}, {angle, angle}};
    struct bridge_table *table;
    struct reason reason = {""};
    if (bridge_table_create(radius, angles, &table, &reason))
        fail_msg("%s", reason.text);
    assert_true(bridge_table_error(table) < tolerance);
    double worst = 0;
    for (int k = 0; k < 1500; k++) {
        const double volume = pow(10, -9 * place(k, 0.754877666));
        const double share = place(k, 0.569840290);
        const double gap = bridge_table_rupture(table, volume) * share *
                           (k % 2 ? 1 : sqrt(volume)) * 0.9999;
        struct equilibrium exact;
        if (find_equilibrium(&bodies, volume, gap, &exact))
            fail_msg("no bridge of %g at %g", volume, gap);
        const double force = 2 * M_PI * arc_force(&bodies, &exact.arc);
        const double steep = 1 + gap / (1.2 * sqrt(volume));
        const double least = BRIDGE_TABLE_FLOOR / steep / steep;
        worst = fmax(worst, fabs(bridge_table_force(table, volume, gap) - force) /
                                fmax(fabs(force), least));
    }
    print_message("# other radius %g, %g degrees: error at most %.1e\n", other, degrees,
                  worst);
    assert_true(worst < tolerance);
    if (degrees < 60) check_ends(table); // of more, bridges may push
    bridge_table_free(table);
}

static void test_error(void **state)
{
    (void)state;
    check_table(1, 0, 1e-5);
    check_table(1, 32, 1e-5); // where two ways to rupture meet
    check_table(1, 80, 1e-5); // and where symmetry breaks long before the gap turns
    check_table(INFINITY, 45, 1e-5);
    check_table(0.4, 90, 1e-5);
}

static void test_many_forces_of_models(void **state)
{
    (void)state;
    for (enum bridge_model model = BRIDGE_WEIGERT; model < BRIDGE_MODELS; model++) {
        const double volume[3] = {1e-6, 1e-4, 1e-2}, gap[3] = {0, 1e-3, 5e-2};
        double force[3];
        bridge_model_forces(model, 0.4, 3, volume, gap, force);
        for (int k = 0; k < 3; k++) {
            const struct bridge bridge = {{1, 1}, {0.4, 0.4}, 1, volume[k]};
            const double one = bridge_model_force(&bridge, model, gap[k], NULL);
            assert_true(fabs(force[k] - one) <= 1e-14 * one);
        }
    }
}

int main(void)
{
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_error),
                                       cmocka_unit_test(test_many_forces_of_models)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
