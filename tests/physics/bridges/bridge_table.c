// SPDX-License-Identifier: GPL-3.0-or-later
// The table of exact forces against the exact forces, off its nodes.
#include "../../test.h"
#include "bridges/bridges.h"
#include "bridges/equilibrium.h"
#include "bridges/ratios.h"
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
    for (int k = 0; k < 400; k++) {
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

TEST(error)
{
    check_table(1, 0, 1e-5);
    check_table(1, 32, 1e-5); // where two ways to rupture meet
    check_table(1, 80, 1e-5); // and where symmetry breaks long before the gap turns
    check_table(INFINITY, 45, 1e-5);
    check_table(0.4, 90, 1e-5);
}

// Of grains from 1 to LARGEST, at random radii, volumes and gaps, every other of nearly
// equal ones, or all of them on a PLANE; LEAST the smallest volume over the cube of the
// smallest radius. Errors up to 0.9 of rupture, to 0.999, and of rupture itself, at
// most LIMIT.
static void check_ratios(double largest, bool plane, double degrees, double least,
                         double most, const double limit[3])
{
    enum { CASES = 120 };
    const double angle = degrees * M_PI / 180;
    const struct bridge_sizes sizes = {
        {1, largest}, {least, most}, {2 * plane, 2 * largest * plane}};
    struct bridge_ratios *ratios;
    struct reason reason = {""};
    if (bridge_ratios_create(&sizes, angle, &ratios, &reason))
        fail_msg("%s", reason.text);
    double worst[3] = {0};
    for (int k = 0; k < CASES; k++) {
        const double a = pow(largest, place(k, 0.754877666));
        const double b =
            plane   ? INFINITY
            : k % 2 ? pow(largest, place(k, 0.819172513))
                    : fmin(a * (1 + 0.1 * pow(place(k, 0.819172513), 4)), largest);
        const double radius = 2 / (1 / a + 1 / b), s = bridge_asymmetry(a, b);
        const double size = least * pow(most / least, place(k, 0.671043607));
        const double volume = size / (radius * radius * radius);
        const struct bodies bodies = {{radius / a, radius / b}, {angle, angle}};
        struct equilibrium last, exact;
        if (find_rupture(&bodies, volume, &last)) fail_msg("no rupture");
        const double share = fmin(place(k, 0.569840290) * 1.05, 0.999);
        const double gap = share * last.gap;
        if (find_equilibrium(&bodies, volume, gap, &exact)) fail_msg("no bridge");
        const double force = 2 * M_PI * arc_force(&bodies, &exact.arc);
        const double steep = 1 + gap / (1.2 * sqrt(volume));
        double ours;
        bridge_ratios_forces(ratios, 1, &s, &volume, &gap, &ours);
        const double error =
            fabs(ours - force) / fmax(fabs(force), BRIDGE_TABLE_FLOOR / steep / steep);
        const double rupture = bridge_ratios_rupture(ratios, s, volume);
        worst[share > 0.9] = fmax(worst[share > 0.9], error);
        worst[2] = fmax(worst[2], fabs(rupture / last.gap - 1));
        assert_true(rupture <= bridge_ratios_rupture(ratios, 0, volume) * (1 + 1e-5));
    }
    print_message("# radii 1 to %g%s, %g degrees: errors at most %.1e %.1e, of rupture "
                  "%.1e\n",
                  largest, plane ? " on a plane" : "", degrees, worst[0], worst[1],
                  worst[2]);
    for (int k = 0; k < 3; k++)
        assert_true(worst[k] < limit[k]);
    bridge_ratios_free(ratios);
}

TEST(unequal_radii)
{
    check_ratios(20, false, 0, 0.05, 0.05, (double[]){1e-5, 1e-4, 1e-5});
    check_ratios(3, false, 20, 1e-3, 1e-2, (double[]){1e-5, 1e-4, 1e-5});
    check_ratios(2, false, 45, 0.01, 0.01, (double[]){1e-5, 1e-3, 1e-4});
    check_ratios(4, true, 20, 1e-2, 1e-1, (double[]){1e-5, 1e-4, 1e-5});
    check_ratios(2, true, 45, 0.1, 1, (double[]){1e-5, 1e-3, 1e-4});
}

// Equal grains have the numbers of their own table, whatever others there are.
TEST(equal_among_unequal)
{
    const struct bridge_sizes one = {{1, 1}, {1e-3, 1e-2}, {0, 0}},
                              many = {{1, 1.01}, {1e-3, 1e-2}, {0, 0}};
    struct bridge_ratios *ratios[2];
    struct bridge_table *table;
    struct reason reason;
    const double angle[2] = {0.3, 0.3}, equal[2] = {1, 1}, none[64] = {0};
    assert_false(bridge_table_create(equal, angle, &table, &reason));
    assert_false(bridge_ratios_create(&one, 0.3, &ratios[0], &reason));
    assert_false(bridge_ratios_create(&many, 0.3, &ratios[1], &reason));
    double volume[64], gap[64], force[64];
    for (int k = 0; k < 64; k++) {
        volume[k] = 1e-3 * pow(10, place(k, 0.754877666));
        gap[k] = 0.25 * place(k, 0.569840290);
    }
    for (int r = 0; r < 2; r++) {
        bridge_ratios_forces(ratios[r], 64, none, volume, gap, force);
        for (int k = 0; k < 64; k++) {
            const double wanted = bridge_table_force(table, volume[k], gap[k]);
            assert_memory_equal(&force[k], &wanted, sizeof wanted);
        }
        bridge_ratios_free(ratios[r]);
    }
    bridge_table_free(table);
}

// Of volumes that are not tabulated, from the nearest that is: force and rupture beside
// the exact ones.
TEST(volumes_beyond)
{
    const struct bridge_sizes sizes[2] = {{{1, 1.25}, {1e-10, 3e-9}, {0, 0}},
                                          {{1, 1.25}, {0.8, 2}, {0, 0}}};
    const double volume[] = {5e-10, 1e-10, 1.3, 2}, within[] = {0.03, 0.08, 0.15, 0.25};
    struct bridge_ratios *both[2];
    struct reason reason;
    for (int k = 0; k < 2; k++)
        assert_false(bridge_ratios_create(&sizes[k], 0, &both[k], &reason));
    for (int k = 0; k < 8; k++) {
        const struct bridge_ratios *ratios = both[k / 4];
        const double v = volume[k / 2], e = k % 2 ? 1.0 / 9 : 0;
        const double s = k % 2 ? bridge_asymmetry(1, 1.25) : 0;
        const struct bodies bodies = {{1 - e, 1 + e}, {0, 0}};
        struct equilibrium last, exact;
        assert_false(find_rupture(&bodies, v, &last));
        assert_close(bridge_ratios_rupture(ratios, s, v), last.gap, v < 1 ? 1e-4 : 0.1);
        for (int share = 0; share < 9; share++) {
            const double gap = pow(0.1 * share, 3) * last.gap;
            double force;
            assert_false(find_equilibrium(&bodies, v, gap, &exact));
            bridge_ratios_forces(ratios, 1, &s, &v, &gap, &force);
            assert_close(force, 2 * M_PI * arc_force(&bodies, &exact.arc),
                         within[k / 2]);
        }
    }
    for (int k = 0; k < 2; k++)
        bridge_ratios_free(both[k]);
}

TEST(many_forces_of_models)
{
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
