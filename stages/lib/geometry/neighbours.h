// SPDX-License-Identifier: GPL-3.0-or-later
// Which grains lie close to which.
#ifndef CRAQUELURE_NEIGHBOURS_H
#define CRAQUELURE_NEIGHBOURS_H

#include "geometry/packing.h"

// All pairs whose surfaces are at most GAP times the sum of their radii apart
// (overlapping ones too), by the nearest image where the box repeats, each once, lower
// index first, sorted. Linked cells: O(n) for grains of similar size. *COUNT gets their
// number; the caller frees the array.
int32_t (*neighbour_pairs(const struct packing *packing, double gap, int *count))[2];

// Orders pairs of grains by the first, then the second; for qsort and bsearch.
int compare_pairs(const void *a, const void *b);

// From grain I to grain J, to its nearest image where the box repeats, m.
struct vector nearest_image(const struct packing *packing, int i, int j);

#endif
