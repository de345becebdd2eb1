// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest of many points, in a box that may be periodic: there distances are those
// to the nearest image.
#pragma once

#include "geometry/linked_cells.h"
#include "geometry/packing.h"

struct places {
    const struct packing *packing; // its box
    const struct vector *at;       // m
    struct linked_cells cells;
};

// For the N places AT. O(n). Keeps PACKING and AT: they must not change or go before
// places_free, which frees what it owns itself.
struct places places_init(const struct packing *packing, int n,
                          const struct vector *at);
void places_free(struct places *places);

// The index of the place nearest to FROM, the lowest of equals; -1 if there is none.
// O(1) for evenly spread places; right for any others. Safe for several threads. By
// rings of cells, until the next ring is farther than the best so far.
int nearest_place(const struct places *places, struct vector from);
