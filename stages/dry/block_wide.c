// SPDX-License-Identifier: GPL-3.0-or-later
// For processors with AVX-512.
#if defined __x86_64__
#pragma GCC target("avx512f,avx512dq,avx512vl,fma")
#endif
#define LANES 8
#define ROWS 8
#define UPDATE_NAME block_update_wide
#include "block_kernel.h"
