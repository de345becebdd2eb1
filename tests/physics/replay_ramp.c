// SPDX-License-Identifier: GPL-3.0-or-later
// The first load, at once and over a ramp, on a bond without dashpots: an oscillator.
// Pulled at once its force overshoots to twice what pulls; by a load that grows over a
// time T, to 1 + |sin(w T / 2)| / (w T / 2) times that (Chopra, Dynamics of
// Structures).
#include "dem_scene.h"
#include "load_in_memory.h"
#include "support_equilibrium.h"

static const double pull = 1e-9;
static const double time_step_safety = 0.002;
static const double bond_radius = 0.5858 * RADIUS;

// In time steps.
static double period(void)
{
    const double mass = 3230 * 4.0 / 3 * M_PI * RADIUS * RADIUS * RADIUS;
    const double stiffness = 8e14 * M_PI * bond_radius * bond_radius;
    struct packing packing = bonded_pair();
    struct dem_setup setup = stiff_setup(&packing);
    setup.time_step_safety = time_step_safety;
    struct dem *dem = create(&setup);
    const double time_step = dem_time_step(dem);
    dem_free(dem);
    packing_free(&packing);
    return 2 * M_PI * sqrt(mass / stiffness) / time_step;
}

// Whether a bond that holds STRENGTH times the pull breaks under it.
static bool breaks(double strength, int64_t ramp)
{
    struct packing packing = bonded_pair();
    const struct dem_setup setup = stiff_setup(&packing);
    uint8_t held[] = {1, 0};
    double time[] = {0}, saturation[] = {1};
    struct vector force[] = {{0, 0, 0}, {pull, 0, 0}};
    const struct load load = {.n_time = 1,
                              .time = time,
                              .saturation = saturation,
                              .source = &(struct rows_in_memory){force, 2},
                              .force = row_in_memory};
    struct replay_settings settings = {.material = setup.material,
                                       .bond = setup.bond,
                                       .held = held,
                                       .unstressed = true,
                                       .support = SUPPORT_FIXED,
                                       .engine = ENGINE_EXPLICIT,
                                       .time_step_safety = time_step_safety,
                                       .cycles = llrint(1.1 * period()),
                                       .ramp = ramp,
                                       .tolerance = NAN,
                                       .threads = 1};
    settings.material.damping_ratio = 0;
    settings.bond.normal_strength =
        strength * pull / (M_PI * bond_radius * bond_radius);
    struct response response = replay_or_fail(&packing, &load, &settings);
    assert_int_equal(response.cycles[0], settings.cycles + ramp);
    const bool broke = response.n_crack > 0;
    response_free(&response);
    packing_free(&packing);
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
