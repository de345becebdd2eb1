// SPDX-License-Identifier: GPL-3.0-or-later
// Bridges at a suction: the same as at the volume they turn out to have, which other
// equations give; and there are none exactly where no volume has as much suction.
#include "../../test.h"
#include "bridges/bridges.h"

#include <math.h>
#include <stdbool.h>

static const double TENSION = 0.07, DEGREE = M_PI / 180;

static struct bridge bodies(double ratio, double angle, double other)
{
    return (struct bridge){
        {1e-6, 1e-6 * ratio}, {angle * DEGREE, other * DEGREE}, TENSION, 0};
}

// Each bridge that is found has, at its volume, that suction and force.
static int compare(const struct bridge *given, double gap, double suction)
{
    struct reason reason;
    struct bridge_state at, by_volume;
    struct bridge bridge = *given;
    const double unit = bridge_effective_radius(given);
    const enum status status = bridge_at_suction(
        given, gap * unit, suction * TENSION / unit, &at, &bridge.volume, &reason);
    if (status == STATUS_NOT_CONVERGED)
        fail_msg("radii 1:%g, angles %g and %g, suction %g, gap %g: not found",
                 bridge.radius[1] / bridge.radius[0], bridge.contact_angle[0],
                 bridge.contact_angle[1], suction, gap);
    if (status) return 0;
    if (bridge_solve(&bridge, gap * unit, &by_volume, &reason))
        fail_msg("suction %g, gap %g: %s", suction, gap, reason.text);
    const double miss = fabs(by_volume.suction / at.suction - 1);
    if (!(miss < 1e-7 && fabs(by_volume.force / at.force - 1) < 1e-7))
        fail_msg("suction %g, gap %g: off by %g", suction, gap, miss);
    if (!(fabs(at.suction * unit / TENSION / suction - 1) < 1e-9))
        fail_msg("the bridge has another suction than the given one");
    return 1;
}

TEST(volume)
{
    static const double ratio[] = {1, 1.5, 5, 50}, angle[] = {0, 30, 60};
    static const double gap[] = {-0.1, -0.001, 0, 1e-4, 0.01, 0.05, 0.2};
    int found = 0, asked = 0;
    for (int r = 0; r < 4; r++)
        for (int a = 0; a < 3; a++)
            for (int g = 0; g < 7; g++)
                // Thinner rings around wide overlaps are not found by volume.
                for (double suction = 2; suction < (g ? 2000 : 200);
                     suction *= 2.1, asked++) {
                    const struct bridge equal = bodies(ratio[r], angle[a], angle[a]);
                    const struct bridge other = bodies(ratio[r], angle[a], 20);
                    found += compare(&equal, gap[g], suction);
                    compare(&other, gap[g], suction);
                }
    assert_in_range(found, asked / 3, asked);
}

// Where spheres overlap, the sides of a bridge are hollow only if both contact angles
// are less than the angle at which the spheres meet: just beyond it there is none.
TEST(wedge)
{
    static const double ratio[] = {1, 0.3, 0.05};
    for (int r = 0; r < 3; r++)
        for (double depth = 0.1; depth < 2; depth += 0.2) {
            const double small = ratio[r], apart = 1 + small - depth * small;
            const double wedge =
                acos((1 + small * small - apart * apart) / (2 * small)) / DEGREE;
            for (double angle = wedge / 2 + 0.01; angle < 90; angle += 10) {
                const struct bridge bridge = bodies(small, angle, angle);
                struct bridge_state is;
                struct reason reason;
                double volume;
                const enum status status = bridge_at_suction(
                    &bridge, -1e-6 * depth * small, 1e5, &is, &volume, &reason);
                if (status != STATUS_NO)
                    fail_msg("radii 1:%g, depth %g, %g degrees: %d", small, depth,
                             angle, status);
            }
        }
}

// The largest suction of bridges of any volume, to 1e-4, by those of 4000 volumes.
static double largest_suction(struct bridge bridge, double separation)
{
    double largest = 0;
    const double unit = bridge_effective_radius(&bridge);
    for (double volume = 1; volume > 1e-9; volume *= 0.99) {
        struct bridge_state state;
        struct reason reason;
        bridge.volume = volume * unit * unit * unit;
        if (bridge_solve(&bridge, separation, &state, &reason)) break;
        largest = fmax(largest, state.suction);
    }
    return largest;
}

TEST(end)
{
    static const double gap[] = {0.003, 0.03, 0.2};
    for (int g = 0; g < 3; g++)
        for (double ratio = 1; ratio < 30; ratio *= 5)
            for (double angle = 0; angle < 50; angle += 40) {
                const struct bridge bridge = bodies(ratio, angle, angle);
                const double separation = gap[g] * bridge_effective_radius(&bridge);
                const double most = largest_suction(bridge, separation);
                struct bridge_state is;
                struct reason reason;
                double volume;
                const bool below = !bridge_at_suction(&bridge, separation, 0.998 * most,
                                                      &is, &volume, &reason);
                const enum status beyond = bridge_at_suction(
                    &bridge, separation, 1.002 * most, &is, &volume, &reason);
                if (!below || beyond != STATUS_NO)
                    fail_msg("gap %g, radii 1:%g, %g degrees: %d %d", gap[g], ratio,
                             angle, below, beyond);
            }
}
