// SPDX-License-Identifier: GPL-3.0-or-later
// Fragments: sets of grains joined by intact bonds, known by their lowest grain.
#pragma once

#include "run.h"
#include "sizes.h"

// Auxiliary grains (an extra layer) belong to none.
struct fragment_counts {
    int count;
    int largest; // grains in it
    int single;  // grains that no bond holds
};

// Grains of each set that the bonds with JOINS (n_bond) join, (n_particle) at its
// lowest grain, 0 at the others; the caller frees it. ROOT (n_particle) becomes the
// lowest grain of each grain's set.
int *fragment_sizes(const struct packing *packing, const uint8_t *joins, int *root);

// 1 for each grain (n_particle) of the largest fragment if the bonds with INTACT
// (n_bond) hold; among equals the one with the lowest grain. The caller frees it.
uint8_t *largest_fragment(const struct packing *packing, const uint8_t *intact);

// Appends the size of each fragment, in grains, to SIZES, unless that is NULL. INTACT:
// (n_bond), 1 where a bond holds. Sizes are appended in the order of their root grains.
// O(grains + bonds).
struct fragment_counts count_fragments(const struct packing *packing,
                                       const uint8_t *intact, struct sizes *sizes);
