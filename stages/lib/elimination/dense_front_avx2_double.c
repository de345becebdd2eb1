// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel of large fronts for AVX2.
#define SIMD_WIDTH 4
#define NUMBER double
#define VECTOR doublew
#define FMADD fmadd
#define TILE_ROWS 4
#define VECTORS 2
#define PASS dense_front_pass_avx2_double
#define GATHER dense_front_gather_avx2_double
#include "dense_front_kernel.h"
