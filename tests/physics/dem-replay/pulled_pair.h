// SPDX-License-Identifier: GPL-3.0-or-later
// The first load on a pair whose bond has no dashpot: an oscillator.
#pragma once

#include "../dem_scene.h"
#include "../support_equilibrium.h"
#include "load_in_memory.h"

#define BOND_RADIUS (0.5858 * RADIUS)

static const double pair_safety = 0.002; // of its time step

// What PULL, which is also the weight where IS_WEIGHT, does over CYCLES and RAMP to a
// bond that holds STRENGTH times as much.
static inline struct response pull_pair(double pull, double strength, int64_t cycles,
                                        int64_t ramp, bool is_weight)
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
                                       .time_step_safety = pair_safety,
                                       .cycles = cycles,
                                       .ramp = ramp,
                                       .tolerance = NAN,
                                       .threads = 1,
                                       .weight = is_weight ? force : NULL};
    settings.material.damping_ratio = 0;
    settings.bond.normal_strength =
        strength * pull / (M_PI * BOND_RADIUS * BOND_RADIUS);
    struct response response = replay_or_fail(&packing, &load, &settings);
    packing_free(&packing);
    return response;
}
