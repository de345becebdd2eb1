// SPDX-License-Identifier: GPL-3.0-or-later
#define LANES 4
#define UPDATE_NAME triangle_update_narrow
#include "triangle_kernel.h"

#include <stdbool.h>

static bool has_wide_vectors(void)
{
#if defined __x86_64__
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

void triangle_update(double *triangle, int n, int n_source, const double *factor,
                     const double *const *source)
{
    if (has_wide_vectors())
        triangle_update_wide(triangle, n, n_source, factor, source);
    else
        triangle_update_narrow(triangle, n, n_source, factor, source);
}
