// SPDX-License-Identifier: GPL-3.0-or-later
// The first load, at once and over a ramp, on a bond without dashpots: an oscillator.
// Pulled at once its force overshoots to twice what pulls; by a load that grows over a
// time T, to 1 + |sin(w T / 2)| / (w T / 2) times that (Chopra, Dynamics of
// Structures).
#include "pulled_pair.h"

static const double pull = 1e-9;

// In time steps.
static double period(void)
{
    const double mass = 3230 * 4.0 / 3 * M_PI * RADIUS * RADIUS * RADIUS;
    const double stiffness = 8e14 * M_PI * BOND_RADIUS * BOND_RADIUS;
    struct packing packing = bonded_pair();
    struct dem_setup setup = stiff_setup(&packing);
    setup.time_step_safety = pair_safety;
    struct dem *dem = create(&setup);
    const double time_step = dem_time_step(dem);
    dem_free(dem);
    packing_free(&packing);
    return 2 * M_PI * sqrt(mass / stiffness) / time_step;
}

// Whether a bond that holds STRENGTH times the pull breaks under it.
static bool breaks(double strength, int64_t ramp)
{
    const int64_t cycles = llrint(1.1 * period());
    struct response response = pull_pair(pull, strength, cycles, ramp, false);
    assert_int_equal(response.cycles[0], cycles + ramp);
    const bool broke = response.n_crack > 0;
    response_free(&response);
    return broke;
}

TEST(at_once_twice_the_load)
{
    assert_true(breaks(1.999, 0));
    assert_false(breaks(2.001, 0));
}

TEST(over_a_ramp_as_the_oscillator)
{
    const double periods[] = {0.25, 0.5, 1, 1.5, 2.5, 5};
    for (size_t k = 0; k < sizeof periods / sizeof *periods; k++) {
        const int64_t ramp = llrint(periods[k] * period());
        const double half = M_PI * (double)ramp / period();
        const double peak = 1 + fabs(sin(half)) / half;
        if (!breaks(peak - 0.002, ramp) || breaks(peak + 0.002, ramp))
            fail_msg("ramp of %g periods: not %g", periods[k], peak);
    }
}
