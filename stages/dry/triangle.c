// SPDX-License-Identifier: GPL-3.0-or-later
#define LANES 4
#define UPDATE_NAME triangle_update_narrow
#include "triangle_kernel.h"

#include "basics/wide_vectors.h"

void triangle_update(double *triangle, int n, int n_source, const double *factor,
                     const double *const *source)
{
    if (has_wide_vectors())
        triangle_update_wide(triangle, n, n_source, factor, source);
    else
        triangle_update_narrow(triangle, n, n_source, factor, source);
}
