// SPDX-License-Identifier: GPL-3.0-or-later
// Fragments: grains that intact bonds still join.
#ifndef CRAQUELURE_CRACKSTATS_FRAGMENT_COUNTS_H
#define CRAQUELURE_CRACKSTATS_FRAGMENT_COUNTS_H

#include "run.h"
#include "sizes.h"

struct fragment_counts {
    int count;
    int largest; // grains in it
    int single;  // grains that no bond holds
};

// 1 for each grain of the largest fragment when the bonds with INTACT hold, the one
// with the lowest grain of equals. (n_particle); the caller frees it.
uint8_t *largest_fragment(const struct packing *packing, const uint8_t *intact);

// Appends the size of each fragment, in grains, to SIZES, unless that is NULL.
struct fragment_counts count_fragments(const struct packing *packing,
                                       const uint8_t *intact, struct sizes *sizes);

#endif
