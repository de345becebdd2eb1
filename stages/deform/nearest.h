// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest of many points, in a box that may be periodic.
#ifndef CRAQUELURE_NEAREST_H
#define CRAQUELURE_NEAREST_H

#include "geometry/linked_cells.h"
#include "geometry/packing.h"

struct places {
    const struct packing *packing; // its box
    const struct vector *at;       // m
    struct linked_cells cells;
};

// O(n). Keeps PACKING and AT. The caller frees it with places_free.
struct places places_init(const struct packing *packing, int n,
                          const struct vector *at);
void places_free(struct places *places);

// The index of the place nearest to FROM, the lowest of equals; -1 if there is none.
// O(1) for evenly spread places.
int nearest_place(const struct places *places, struct vector from);

#endif
