// SPDX-License-Identifier: GPL-3.0-or-later
#include "count.h"

#include "basics/memory.h"

// Bonds between two layers of a lattice lie on the border of two slices but for
// rounding.
static const double border = 1e-9; // of the height

static int slice_of(const struct cracks *cracks, double z, int n_slice)
{
    const double height = (z - cracks->bottom) / (cracks->top - cracks->bottom);
    const double place = (height - border) * n_slice;
    return place < 0 ? 0 : place >= n_slice ? n_slice - 1 : (int)place;
}

struct counts count_cracks(const struct cracks *cracks, int n_slice)
{
    struct counts counts = {.slice = allocate((size_t)n_slice, sizeof *counts.slice)};
    for (int k = 0; k < cracks->count; k++) {
        const int period =
            cracks->time[k] <= cracks->first_period_end ? PERIOD_FIRST : PERIOD_SECOND;
        counts.period[period][cracks->mode[k]]++;
        counts.slice[slice_of(cracks, cracks->height[k], n_slice)][cracks->mode[k]]++;
    }
    return counts;
}
