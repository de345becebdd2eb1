// SPDX-License-Identifier: GPL-3.0-or-later
// Rings in equilibrium with a suction: where one is found it has that suction, and
// where none is, no bridge of any volume has as much.
#include "../../test.h"
#include "bridges/bridges.h"
#include "force-protocol/pendular_rings.h"

#include <math.h>

static const double tension = 3;

// The suction of the bridge of VOLUME, of the cube of the effective radius; below 0:
// there is none.
static double suction_of(const double radius[2], double angle, double gap,
                         double volume, double *force)
{
    struct bridge bridge = {.radius = {radius[0], radius[1]},
                            .contact_angle = {angle, angle},
                            .surface_tension = tension};
    struct bridge_state state = {0};
    struct reason unused;
    bridge.volume = volume * pow(bridge_effective_radius(&bridge), 3);
    const enum status status = bridge_solve(&bridge, gap, &state, &unused);
    *force = state.force;
    return status == STATUS_OK ? state.suction : -1;
}

// The most suction at this gap: among 41 volumes, then around the best, ever nearer; 0
// where no bridge holds.
static double most_suction(const double radius[2], double angle, double gap)
{
    double from = log(1e-8), to = 0, unused, most = 0;
    for (int round = 0; round < 6; round++) {
        const double step = (to - from) / 40;
        double best = from;
        for (int v = 0; v <= 40; v++) {
            const double here =
                suction_of(radius, angle, gap, exp(from + v * step), &unused);
            if (here > most) best = from + v * step;
            most = fmax(most, here);
        }
        from = best - 2 * step;
        to = best + 2 * step;
    }
    return most;
}

TEST(found_or_there_is_none)
{
    static const double angle[] = {0, 0.6}, other[] = {1, 4};
    int found = 0, none = 0;
    for (int k = 0; k < 4; k++)
        for (double gap = 0.02; gap < 0.4; gap += 0.04) {
            const double radius[2] = {1, other[k / 2]};
            const struct ring_law law = {.rule = RING_SUCTION,
                                         .suction = 5,
                                         .surface_tension = 1,
                                         .contact_angle = angle[k % 2]};
            struct bridge bridge = {.radius = {radius[0], radius[1]},
                                    .contact_angle = {angle[k % 2], angle[k % 2]},
                                    .surface_tension = 1};
            struct reason reason;
            double force;
            assert_int_equal(
                solve_ring(radius, gap, &law, &bridge.volume, &force, &reason),
                STATUS_OK);
            found += bridge.volume > 0;
            none += !(bridge.volume > 0);
            struct bridge_state is;
            if (bridge.volume > 0) {
                assert_int_equal(bridge_solve(&bridge, gap, &is, &reason), STATUS_OK);
                assert_true(fabs(is.suction / 5 - 1) < 1e-10);
            } else
                assert_true(most_suction(radius, angle[k % 2], gap) < 5 * tension);
        }
    assert_true(found >= 8 && none >= 8);
}

static void find_ring(const double radius[2], double angle, double gap, double suction,
                      double *volume, double *force)
{
    const struct ring_law law = {.rule = RING_SUCTION,
                                 .volume = 0.5, // not asked for
                                 .suction = suction,
                                 .surface_tension = tension,
                                 .contact_angle = angle};
    struct reason reason;
    if (solve_ring(radius, gap, &law, volume, force, &reason))
        fail_msg("%s", reason.text);
}

static double cube(const double radius[2])
{
    return pow(2 * radius[0] * radius[1] / (radius[0] + radius[1]), 3);
}

static const double angles[] = {0, 0.6}, others[] = {1, 3};

// A bridge that would shrink under more suction is the ring of liquid of its suction.
TEST(a_bridge_is_the_ring_of_its_suction)
{
    static const double gaps[] = {0, 0.01, 0.1};
    int count = 0;
    for (int k = 0; k < 12; k++)
        for (double log_volume = -8.99; log_volume < 0; log_volume += 0.48) {
            const double radius[2] = {1, others[k % 2]}, volume = pow(10, log_volume);
            const double angle = angles[k / 2 % 2], gap = gaps[k / 4];
            double wanted, unused, found, force;
            const double suction = suction_of(radius, angle, gap, volume, &wanted);
            const double larger = suction_of(radius, angle, gap, 1.1 * volume, &unused);
            if (!(suction > 0 && larger < suction)) continue;
            find_ring(radius, angle, gap, suction, &found, &force);
            assert_close(found / cube(radius), volume, 1e-7);
            assert_close(force, wanted, 1e-7);
            count++;
        }
    assert_true(count > 80);
}

TEST(rings_have_a_least_volume)
{
    const double radius[2] = {1, 2};
    double volume, force, unused;
    const double most = suction_of(radius, 0, 0, 1e-9, &unused);
    find_ring(radius, 0, 0, 1.01 * most, &volume, &force);
    assert_true(volume == 0 && force == 0);
}

// A ring is found up to the most suction that bridges of any volume have, however near.
TEST(rings_are_found_up_to_the_most_suction)
{
    static const double gaps[] = {0.01, 0.05, 0.2};
    for (int k = 0; k < 12; k++) {
        const double radius[2] = {1, others[k % 2]};
        const double angle = angles[k / 2 % 2], gap = gaps[k / 4];
        const double most = most_suction(radius, angle, gap);
        assert_true(most > 0);
        for (int above = 0; above < 2; above++) {
            double volume, force;
            find_ring(radius, angle, gap, most * (above ? 1 + 1e-6 : 1 - 1e-6), &volume,
                      &force);
            assert_int_equal(volume > 0, !above);
            assert_int_equal(force != 0, !above);
        }
    }
}
