// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the processor has the vectors of eight numbers that *_avx512.c are compiled
// for. False on other processors, which take the files for AVX2 or plain C: the digits
// are the same.
#pragma once

#include <stdbool.h>

// The three parts that the kernels use: foundation, doubles and quadwords, vector
// lengths. Cheap: GCC's runtime found them at the start. That a processor has AVX2 and
// FMA is taken for granted where the program was compiled for them.
static inline bool has_avx512(void)
{
#if defined __x86_64__
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}
