// SPDX-License-Identifier: GPL-3.0-or-later
// Rings in equilibrium with a suction: where one is found it has that suction, and
// where none is, no bridge of any volume has as much.
#include "../test.h"
#include "bridges/bridges.h"
#include "force-protocol/rings.h"
#include <math.h>
#include <stdio.h>

// The most suction at SEPARATION of bridges of 120 volumes; 0 where none holds.
static double most_suction(struct bridge bridge, double separation)
{
    double most = 0;
    for (int k = 0; k <= 120; k++) {
        struct bridge_state state;
        struct reason unused;
        bridge.volume =
            pow(10, -6 + 0.05 * k) * pow(bridge_effective_radius(&bridge), 3);
        if (bridge_solve(&bridge, separation, &state, &unused) == STATUS_OK)
            most = fmax(most, state.suction);
    }
    return most;
}

static void found_or_there_is_none(void **state)
{
    (void)state;
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
            } else if (!(most_suction(bridge, gap) < 5))
                fail_msg("gap %g, radius %g, angle %g: a bridge has suction %g", gap,
                         radius[1], angle[k % 2], most_suction(bridge, gap));
        }
    assert_true(found >= 8 && none >= 8);
}

int main(void)
{
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {cmocka_unit_test(found_or_there_is_none)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
