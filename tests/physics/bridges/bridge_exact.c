// SPDX-License-Identifier: GPL-3.0-or-later
// The exact bridge: against shapes known in closed form, against energy, and against
// symmetries.
#include "../../test.h"
#include "bridges/bridges.h"
#include "bridges/equilibrium.h"

#include <math.h>
#include <stdbool.h>

static void close_to(double value, double reference, double tolerance, const char *what)
{
    if (!(fabs(value - reference) <= tolerance * fabs(reference)))
        fail_msg("%s: %.15g, not %.15g", what, value, reference);
}

static struct bridge_state solved(const struct bridge *bridge, double separation)
{
    struct bridge_state state;
    struct reason reason = {""};
    if (bridge_solve(bridge, separation, &state, &reason)) fail_msg("%s", reason.text);
    return state;
}

static double sagitta(double radius, double angle)
{
    return 2 * radius * sin(0.5 * angle) * sin(0.5 * angle);
}

static double cap_volume(double radius, double angle)
{
    const double h = sagitta(radius, angle);
    return M_PI * h * h * (3 * radius - h) / 3;
}

// Two equal spheres with a meridian of HEIGHT and revolved VOLUME over both caps, seen
// under ANGLE: the bridge that has it.
static struct bridge between(double radius, double angle, double contact_angle,
                             double revolved)
{
    return (struct bridge){{radius, radius},
                           {contact_angle, contact_angle},
                           0.05,
                           revolved - 2 * cap_volume(radius, angle)};
}

// ---- closed forms ------------------------------------------------------------------

// y = c cosh(x/c): no suction, and the force is 2 pi c times the tension.
TEST(catenoid)
{
    const double radius = 2e-3;
    for (double liquid = 0.1; liquid < 0.7; liquid += 0.1)
        for (double angle = 0.3; angle < 0.9; angle += 0.2) {
            const double y = radius * sin(liquid), c = y * sin(liquid + angle);
            const double x = c * acosh(y / c);
            const double revolved = M_PI * c * c * (x + 0.5 * c * sinh(2 * x / c));
            const struct bridge bridge = between(radius, liquid, angle, revolved);
            const double gap = 2 * (x - sagitta(radius, liquid));
            if (!(bridge.volume > 0)) continue;
            struct bridge_state widest;
            struct reason reason;
            assert_int_equal(bridge_solve_rupture(&bridge, &widest, &reason), 0);
            if (gap > 0.999 * widest.separation) continue; // may be the unstable one
            const struct bridge_state is = solved(&bridge, gap);
            if (fabs(is.half_filling_angle[0] - liquid) > 1e-3) continue;
            close_to(is.force, 2 * M_PI * c * 0.05, 1e-10, "force of a catenoid");
            close_to(is.neck_radius, c, 1e-10, "neck of a catenoid");
            assert_true(fabs(is.suction) < 1e-12 * 0.05 / c);
        }
}

// Contact lines at which the surface is vertical, at any length up to Rayleigh's.
TEST(cylinder)
{
    const double radius = 3e-6;
    for (double liquid = 0.2; liquid < 1.3; liquid += 0.2)
        for (double share = 0.1; share < 0.8; share += 0.2) {
            const double y = radius * sin(liquid);
            const double gap = share * y, height = gap + 2 * sagitta(radius, liquid);
            if (height > 2 * y) continue;
            const struct bridge bridge =
                between(radius, liquid, M_PI / 2 - liquid, M_PI * y * y * height);
            const struct bridge_state is = solved(&bridge, gap);
            close_to(is.force, M_PI * y * 0.05, 1e-10, "force of a cylinder");
            close_to(is.suction, -0.05 / y, 1e-10, "suction of a cylinder");
            close_to(is.free_area, 2 * M_PI * y * height, 1e-10, "area of a cylinder");
        }
}

// A ball of liquid pierced by both spheres does not pull.
TEST(sphere)
{
    const double radius = 1, liquid = 0.5;
    for (double slope = 0.2; slope < 1.2; slope += 0.2) {
        const double ball = radius * sin(liquid) / cos(slope);
        const double x = ball * sin(slope);
        const double revolved = 2 * M_PI * x * (ball * ball - x * x / 3);
        const double gap = 2 * (x - sagitta(radius, liquid));
        const struct bridge bridge =
            between(radius, liquid, M_PI / 2 - liquid + slope, revolved);
        if (!(bridge.volume > 0) || gap < 0) continue;
        const struct bridge_state is = solved(&bridge, gap);
        assert_true(fabs(is.force) < 1e-12 * 0.05 * radius);
        close_to(is.suction, -2 * 0.05 / ball, 1e-10, "suction of a ball");
    }
}

// At contact the force tends to 2 pi R gamma cos(theta) as the volume vanishes, with
// the root of the volume.
TEST(vanishing_volume)
{
    for (int degrees = 0; degrees <= 80; degrees += 20) {
        const double angle = degrees * M_PI / 180;
        double last = INFINITY;
        for (double volume = 1e-4; volume > 1e-17; volume *= 1e-4) {
            const struct bridge bridge = {{1, 1}, {angle, angle}, 1, volume};
            const double force = solved(&bridge, 0).force;
            const double error = fabs(force / (2 * M_PI * cos(angle)) - 1);
            assert_true(error < 10 * pow(volume, 0.25));
            assert_true(error < 0.5 * last);
            last = error;
        }
    }
}

// ---- energy ------------------------------------------------------------------------

// dE/da at constant volume by central differences of sixth order.
static double energy_slope(const struct bridge *bridge, double separation, double h)
{
    static const double weight[3] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
    double slope = 0;
    for (int k = 1; k <= 3; k++)
        slope += weight[k - 1] * (solved(bridge, separation + k * h).energy -
                                  solved(bridge, separation - k * h).energy);
    return slope / h;
}

TEST(force_is_slope_of_energy)
{
    static const double shapes[][4] = {
        // other radius, two angles, volume
        {1, 0, 0, 1e-3},       {1, 0.6, 0.6, 1e-1},
        {0.3, 0.4, 0.4, 1e-3}, {INFINITY, 0.2, 1.2, 1e-2},
        {0.1, 1.5, 0.3, 1e-4}, {1, 1.8, 1.8, 1e-2}};
    double worst = 0;
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
        const struct bridge bridge = {
            {1, shapes[k][0]}, {shapes[k][1], shapes[k][2]}, 1, shapes[k][3]};
        struct bridge_state widest;
        struct reason reason;
        assert_int_equal(bridge_solve_rupture(&bridge, &widest, &reason), 0);
        for (double share = -0.3; share < 0.9; share += 0.2) {
            const double gap = share * widest.separation;
            const struct bridge_state is = solved(&bridge, gap);
            const double slope = energy_slope(&bridge, gap, 4e-3 * widest.separation);
            const double scale =
                fabs(is.force) + bridge_effective_radius(&bridge) * cbrt(shapes[k][3]);
            worst = fmax(worst, fabs(is.force - slope) / scale);
        }
    }
    print_message("# force and slope of energy differ by at most %.1e\n", worst);
    assert_true(worst < 1e-8);
}

// ---- symmetries --------------------------------------------------------------------

TEST(scale_free)
{
    const struct bridge small = {{2e-9, 5e-9}, {0.3, 0.9}, 0.07, 1e-29};
    struct bridge large = small;
    for (int k = 0; k < 2; k++)
        large.radius[k] *= 1e12;
    large.volume *= 1e36;
    const struct bridge_state near = solved(&small, 1.5e-10), far = solved(&large, 150);
    close_to(far.force, 1e12 * near.force, 1e-12, "force in another scale");
    close_to(far.energy, 1e24 * near.energy, 1e-12, "energy in another scale");
    close_to(far.suction, 1e-12 * near.suction, 1e-12, "suction in another scale");
}

TEST(exchange_of_bodies)
{
    const struct bridge one = {{1, 0.2}, {0.1, 1.0}, 1, 1e-4};
    const struct bridge other = {{0.2, 1}, {1.0, 0.1}, 1, 1e-4};
    const struct bridge_state a = solved(&one, 0.02), b = solved(&other, 0.02);
    close_to(a.force, b.force, 1e-11, "force of bodies exchanged");
    close_to(a.half_filling_angle[0], b.half_filling_angle[1], 1e-11, "filling angle");
}

TEST(plane_is_a_large_sphere)
{
    const struct bridge plane = {{1, INFINITY}, {0.2, 0.5}, 1, 1e-3};
    const double force = solved(&plane, 0.05).force;
    for (double radius = 1e2; radius < 1e9; radius *= 1e2) {
        const struct bridge large = {{1, radius}, {0.2, 0.5}, 1, 1e-3};
        close_to(solved(&large, 0.05).force, force, 3 / radius, "force on a plane");
    }
}

TEST(continuous_at_contact)
{
    const struct bridge bridge = {{1, 0.5}, {0.2, 0.2}, 1, 1e-3};
    const double force = solved(&bridge, 0).force;
    for (double gap = 1e-4; gap > 1e-13; gap *= 0.1) {
        close_to(solved(&bridge, gap).force, force, 100 * gap, "force before contact");
        close_to(solved(&bridge, -gap).force, force, 100 * gap, "force in overlap");
    }
}

TEST(ruptures_from_below)
{
    const struct bridge bridge = {{1, 0.5}, {0.2, 0.2}, 1, 1e-3};
    struct bridge_state widest, is;
    struct reason reason;
    assert_int_equal(bridge_solve_rupture(&bridge, &widest, &reason), STATUS_OK);
    double last = solved(&bridge, 0.9 * widest.separation).force - widest.force;
    // The force falls to that at rupture with the root of the distance from it.
    for (double short_of = 1e-3; short_of > 1e-11; short_of *= 0.01) {
        const double more =
            solved(&bridge, (1 - short_of) * widest.separation).force - widest.force;
        assert_true(more > 0 && more < 0.5 * last);
        last = more;
    }
    assert_int_equal(bridge_solve(&bridge, widest.separation, &is, &reason), STATUS_OK);
    assert_int_equal(
        bridge_solve(&bridge, (1 + 1e-7) * widest.separation, &is, &reason), STATUS_NO);
}

// The whole range of volumes, angles and ratios: a stable bridge at contact, and a
// rupture, everywhere.
TEST(whole_range)
{
    static const double ratios[] = {1, 0.5, 0.01, 1e-4, 0};
    for (int r = 0; r < 5; r++)
        for (int degrees = 0; degrees <= 120; degrees += 15)
            for (double volume = 1e-9; volume < 2; volume *= 10) {
                const double angle = degrees * M_PI / 180;
                const double larger = 2 / (1 + ratios[r]);
                const struct bodies bodies = {{larger, larger * ratios[r]},
                                              {angle, angle}};
                struct equilibrium is;
                if (find_equilibrium(&bodies, volume, 0, &is) || !(is.stability > 0))
                    fail_msg("none at contact: %g %d %g", ratios[r], degrees, volume);
                if (find_rupture(&bodies, volume, &is) || !(is.gap > 0))
                    fail_msg("no rupture: %g %d %g", ratios[r], degrees, volume);
                const double widest = is.gap;
                if (find_equilibrium(&bodies, volume, 0.99 * widest, &is))
                    fail_msg("none before rupture: %g %d %g", ratios[r], degrees,
                             volume);
                const struct span span = span_of(&bodies, &is.arc);
                close_to(span.gap, 0.99 * widest, 1e-10, "gap");
                close_to(span.volume, volume, 1e-10, "volume");
            }
}

// Solutions of other branches, which lie at the same gap, would show as jumps in the
// force. Places are even in the root of the distance from rupture, in which the force
// is smooth there; near contact it has a scale of its own, which the first are spared.
static void check_smooth(double ratio, int degrees, double volume)
{
    enum { PLACES = 50, SPARED = 15 };
    const double angle = degrees * M_PI / 180, larger = 2 / (1 + ratio);
    const struct bodies bodies = {{larger, larger * ratio}, {angle, angle}};
    struct equilibrium is;
    double force[PLACES + 1];
    if (find_rupture(&bodies, volume, &is)) fail_msg("no rupture");
    const double widest = is.gap;
    for (int k = 0; k < PLACES; k++) {
        const double root = 1 - (double)k / PLACES;
        if (find_equilibrium(&bodies, volume, widest * (1 - root * root), &is))
            fail_msg("none: %g %d %g at %d", ratio, degrees, volume, k);
        force[k] = arc_force(&bodies, &is.arc);
    }
    for (int k = SPARED; k < PLACES - 2; k++) {
        const double rough = force[k - 2] - 4 * force[k - 1] + 6 * force[k] -
                             4 * force[k + 1] + force[k + 2];
        if (fabs(rough) > 0.03 * (fabs(force[k]) + cbrt(volume)))
            fail_msg("a jump: %g %d %g at %d", ratio, degrees, volume, k);
    }
}

TEST(no_jump_to_other_branches)
{
    static const double ratios[] = {1, 0.7, 0.3, 0.1, 0};
    for (int r = 0; r < 5; r++)
        for (int degrees = 0; degrees <= 120; degrees += 10)
            for (double volume = 1e-9; volume < 2; volume *= 10)
                check_smooth(ratios[r], degrees, volume);
}

// The gap of rupture grows smoothly with the volume: long strides along a branch do not
// end on another one. These few of nearly equal radii once did.
TEST(rupture_is_smooth_in_volume)
{
    const double e = 0.052734375;
    const struct bodies bodies = {{1 - e, 1 + e}, {0.2, 0.2}};
    double last = 0;
    for (int k = 0; k <= 200; k++) {
        const double volume = 0.5 + 0.0025 * k;
        struct equilibrium is;
        if (find_rupture(&bodies, volume, &is)) fail_msg("no rupture: %g", volume);
        if (k > 0 && !(is.gap > last && is.gap < 1.01 * last))
            fail_msg("volume %g ruptures at %g, a smaller one at %g", volume, is.gap,
                     last);
        last = is.gap;
    }
}

TEST(no_bridge)
{
    static const struct bridge none[] = {{{1, 0}, {0, 0}, 1, 1e-3},
                                         {{1, 1}, {0, 4}, 1, 1e-3},
                                         {{INFINITY, INFINITY}, {0, 0}, 1, 1e-3},
                                         {{1, 1}, {0, 0}, 1, 0},
                                         {{1, NAN}, {0, 0}, 1, 1e-3}};
    for (size_t k = 0; k < sizeof none / sizeof *none; k++) {
        struct bridge_state is;
        struct reason reason;
        assert_int_equal(bridge_solve(&none[k], 0, &is, &reason), STATUS_BAD_DATA);
    }
}
