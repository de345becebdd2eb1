// SPDX-License-Identifier: GPL-3.0-or-later
// Solutions of several right-hand sides side by side, four or eight to a row: the
// factor is read once for all, and each lane has the digits that it would have alone.
#include "supernodal_state.h"

#include "vector_kernels.h"

#include <string.h>

void supernodal_forward_lanes(const struct supernodal *f, const int *place,
                              const double *x, double *half)
{
    const struct vector_kernels *kernels = vector_kernels();
    const size_t bytes = LANES * sizeof *x;
    for (int k = 0; k < f->n; k++)
        memcpy(half + (long)f->place[k] * LANES, x + (long)place[k] * LANES, bytes);
    for (int s = 0; s < f->n_super; s++)
        kernels->forward_eight(&f->super[s], half);
}

void supernodal_backward_lanes(const struct supernodal *f, const int *place,
                               double *half, double *x)
{
    const struct vector_kernels *kernels = vector_kernels();
    const size_t bytes = LANES * sizeof *x;
    for (int s = f->n_super - 1; s >= 0; s--)
        kernels->backward_eight(&f->super[s], half);
    for (int k = 0; k < f->n; k++)
        memcpy(x + (long)place[k] * LANES, half + (long)f->place[k] * LANES, bytes);
}
