// SPDX-License-Identifier: GPL-3.0-or-later
// Which grains lie close to which.
#pragma once

#include "geometry/packing.h"

// Spheres in a box that may repeat: two are near when their centres, by the nearest
// image, are at most the sum of their reaches apart.
struct spheres {
    int count;
    const struct vector *position; // (count)
    const double *reach;           // (count) > 0
    double lower[3];               // of the box, used where it repeats
    double period[3];              // 0 where it does not
    int threads;                   // >= 1
};

// All near pairs, each once, lower index first, sorted. Linked cells, one grid for each
// halving of the reach, so that it is O(count) for spheres of any sizes. *COUNT gets
// their number; the caller frees the array. The same for any number of threads. Never
// NULL, also for none.
int32_t (*near_pairs(const struct spheres *all, int *count))[2];

// All pairs of grains whose centres are at most the sum of their REACHES (n_particle),
// > 0, apart; otherwise as above.
int32_t (*reaching_pairs(const struct packing *packing, const double *reach,
                         int *count))[2];

// All pairs of grains whose surfaces are at most GAP times the sum of their radii apart
// (overlapping ones too); otherwise as above.
int32_t (*neighbour_pairs(const struct packing *packing, double gap, int *count))[2];

// Orders pairs of grains (int32_t[2]) by the first, then the second; for qsort and
// bsearch.
int compare_pairs(const void *a, const void *b);

// APART, m, less whole boxes along the axes that repeat: the way to the nearest image.
static inline struct vector shortest_image(const struct packing *packing,
                                           struct vector apart)
{
    for (int axis = 0; axis < 3; axis++) {
        if (!packing->periodic[axis]) continue;
        const double edge =
            component(packing->upper, axis) - component(packing->lower, axis);
        const double along = component(apart, axis);
        if (fabs(along) >= edge / 2) // else round gives 0, and takes longer
            set_component(&apart, axis, along - edge * round(along / edge));
    }
    return apart;
}

// From grain I to grain J, to its nearest image where the box repeats, m. Exactly
// opposite from J to I, and right wherever the positions lie.
static inline struct vector nearest_image(const struct packing *packing, int i, int j)
{
    return shortest_image(packing,
                          subtract(packing->position[j], packing->position[i]));
}
