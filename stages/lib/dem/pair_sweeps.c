// SPDX-License-Identifier: GPL-3.0-or-later
// The compiled pair sweeps, by the set of features that a scene needs (engine.h).
#include "dem/engine.h"

#define AVX2(features) [features] = sweep_avx2_##features,
#define AVX512(features) [features] = sweep_avx512_##features,

pair_sweep *const pair_sweeps_avx2[FEATURE_SETS] = {
    EACH_SET(AVX2) EACH_PARALLEL_BOND_SET(AVX2) EACH_ROLLING_SET(AVX2)};
pair_sweep *const pair_sweeps_avx512[FEATURE_SETS] = {
    EACH_SET(AVX512) EACH_PARALLEL_BOND_SET(AVX512) EACH_ROLLING_SET(AVX512)};
