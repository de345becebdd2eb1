// SPDX-License-Identifier: GPL-3.0-or-later
// Counts by classes. A share on the border of two classes, to 1e-9, belongs to the
// lower one; in profiles over the height it counts half in each, so that bonds between
// two layers of a lattice give a symmetric profile.
//
//     class = floor((share - border) n), 0 to n - 1;  border = 1e-9.
// Shares of the saturation count from 1 down, so the first class is the wettest.
#include "count.h"

#include "basics/memory.h"

#include <stdlib.h>

static const double BORDER = 1e-9; // rounding, of the whole

static int class_at(double place, int n)
{
    return place < 0 ? 0 : place >= n ? n - 1 : (int)place;
}

int class_of(double share, int n)
{
    return class_at((share - BORDER) * n, n);
}

// The slice at SHARE of the height. Of a box that REPEATS along z the last lies below
// the first: a bond or throat across that side has its middle on either side of it.
static int slice_at(double share, int n, bool repeats)
{
    return class_at((repeats ? share - floor(share) : share) * n, n);
}

struct slices slices_at(const struct packing *packing, double z, int n)
{
    const double share = (z - packing->lower.z) / (packing->upper.z - packing->lower.z);
    const bool repeats = packing->periodic[2];
    return (struct slices){
        {slice_at(share - BORDER, n, repeats), slice_at(share + BORDER, n, repeats)}};
}

struct slices slices_of_bond(const struct packing *packing, int bond, int n)
{
    const double z = packing->position[packing->bond[bond][0]].z +
                     0.5 * bond_vector(packing, bond).z;
    return slices_at(packing, z, n);
}

struct counts counts_init(struct classes classes)
{
    const size_t n_slice = (size_t)classes.n_slice;
    const size_t n_interval = (size_t)classes.n_interval;
    struct counts counts = {0};
    counts.slice = allocate(n_slice, sizeof *counts.slice);
    counts.saturation = allocate(n_interval, sizeof *counts.saturation);
    counts.time = allocate(n_interval, sizeof *counts.time);
    counts.place = NEW_ARRAY(double, n_interval *n_slice);
    return counts;
}

void counts_free(struct counts *counts)
{
    free(counts->slice);
    free(counts->saturation);
    free(counts->time);
    free(counts->place);
    *counts = (struct counts){0};
}

void count_all(double all[MODE_COUNT], const struct counts *counts)
{
    for (int mode = 0; mode < MODE_COUNT; mode++)
        all[mode] =
            counts->period[PERIOD_FIRST][mode] + counts->period[PERIOD_SECOND][mode];
}

void count_cracks(struct counts *counts, const struct run *run, struct classes classes)
{
    for (int k = 0; k < run->n_crack; k++) {
        const int mode = run->mode[k];
        const struct slices in =
            slices_of_bond(&run->packing, run->bond[k], classes.n_slice);
        const int drier = class_of(1 - run->saturation[k], classes.n_interval);
        const double elapsed = run->end > 0 ? run->time[k] / run->end : 0;
        counts->period[run->time[k] <= run->first_period_end ? PERIOD_FIRST
                                                             : PERIOD_SECOND][mode]++;
        counts->saturation[drier][mode]++;
        counts->time[class_of(elapsed, classes.n_interval)][mode]++;
        for (int half = 0; half < 2; half++) {
            const size_t slice = (size_t)in.slice[half];
            counts->slice[slice][mode] += 0.5;
            counts->place[(size_t)drier * (size_t)classes.n_slice + slice] += 0.5;
        }
    }
}
