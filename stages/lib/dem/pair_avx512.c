// SPDX-License-Identifier: GPL-3.0-or-later
// The pair sweeps for processors with AVX-512: 8 pairs at once.
#pragma GCC target("avx512f,avx512dq,avx512vl,avx512bw")
#define LANES 8
#define SWEEP_NAME(features) sweep_avx512_##features
#include "dem/pair_kernel.h"
