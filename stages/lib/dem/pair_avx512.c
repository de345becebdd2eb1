// SPDX-License-Identifier: GPL-3.0-or-later
// The pair sweeps for AVX-512: 8 pairs at once.
#pragma GCC target("avx512f,avx512dq,avx512vl,avx512bw")
#define SIMD_WIDTH 8
#define SWEEP_NAME(features) sweep_avx512_##features
#define GAPS_NAME pair_gaps_avx512
#include "dem/pair_kernel.h"
