// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel of large fronts for AVX2.
#define SIMD_WIDTH 4
#define NUMBER float
#define VECTOR floatw
#define FMADD fmadd_float
#define TILE_ROWS 4
#define VECTORS 2
#define PASS dense_front_pass_avx2_float
#define GATHER dense_front_gather_avx2_float
#include "dense_front_kernel.h"
