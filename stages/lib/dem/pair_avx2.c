// SPDX-License-Identifier: GPL-3.0-or-later
// The pair sweeps for AVX2, which every processor of the baseline has: 4 pairs at once.
#define SIMD_WIDTH 4
#define SWEEP_NAME(features) sweep_avx2_##features
#define GAPS_NAME pair_gaps_avx2
#include "dem/pair_kernel.h"
