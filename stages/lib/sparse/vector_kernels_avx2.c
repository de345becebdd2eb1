// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels for AVX2.
#define SIMD_WIDTH 4
#define NAMED(name) name##_avx2
#include "vector_kernels_template.h"
