// SPDX-License-Identifier: GPL-3.0-or-later
// The compiled pair sweeps by what a scene needs.
#include "dem/engine.h"

#define NARROW(features) [features] = sweep_narrow_##features,
#define WIDE(features) [features] = sweep_wide_##features,

pair_sweep *const pair_sweeps_narrow[FEATURE_SETS] = {
    EACH_SET(NARROW) EACH_PARALLEL_BOND_SET(NARROW)};
pair_sweep *const pair_sweeps_wide[FEATURE_SETS] = {EACH_SET(WIDE)
                                                        EACH_PARALLEL_BOND_SET(WIDE)};
