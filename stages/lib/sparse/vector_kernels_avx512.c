// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels for AVX-512.
#if defined __x86_64__
#pragma GCC target("avx512f,avx512dq,avx512vl,fma")
#endif
#define SIMD_WIDTH 8
#define NAMED(name) name##_avx512
#include "vector_kernels_template.h"
