// SPDX-License-Identifier: GPL-3.0-or-later
// Fragments: grains that intact bonds join. A fragment is known by its lowest grain; a
// grain without intact bonds is a fragment of its own.
//
// How one is used, as often as bonds break:
//     fragments_begin(&fragments);
//     for each intact bond: fragments_join(&fragments, i, j);
//     fragments_end(&fragments, fixed, NULL);
// Then of[i] == of[j] tells whether i and j are in one piece, in any order of the
// bonds. `of` means nothing between begin and end.
#pragma once

#include <stdbool.h>
#include <stdint.h>

// It owns both arrays.
struct fragments {
    int n;
    int32_t *of;   // (n) the lowest grain of its fragment
    bool *is_held; // (n) by that grain: never let go
};

// For N grains. The caller frees them with fragments_free.
struct fragments fragments_init(int n);
void fragments_free(struct fragments *fragments);

// Found in three calls: begin, join for each intact bond, end. Each costs nearly O(n +
// bonds) in all (basics/disjoint_sets.h).
void fragments_begin(struct fragments *fragments);
void fragments_join(struct fragments *fragments, int grain, int other);

// Held are those with a FIXED (n) grain, or where there is none, the largest (the first
// of equals), if it is more than one grain. Grains that ARE GONE (NULL: none) do not
// count.
void fragments_end(struct fragments *fragments, const uint8_t *fixed,
                   const bool *is_gone);
