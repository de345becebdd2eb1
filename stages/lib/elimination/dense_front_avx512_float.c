// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel of large fronts for AVX-512.
#if defined __x86_64__
#pragma GCC target("avx512f,avx512dq,avx512vl,fma")
#endif
#define SIMD_WIDTH 8
#define NUMBER float
#define VECTOR floatw
#define FMADD fmadd_float
#define TILE_ROWS 8
#define VECTORS 3
#define PASS dense_front_pass_avx512_float
#define GATHER dense_front_gather_avx512_float
#include "dense_front_kernel.h"
