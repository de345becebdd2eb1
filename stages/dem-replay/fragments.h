// SPDX-License-Identifier: GPL-3.0-or-later
// Fragments: grains that intact bonds join.
#ifndef CRAQUELURE_FRAGMENTS_H
#define CRAQUELURE_FRAGMENTS_H

#include "joint.h"

struct fragments {
    int n;
    int32_t *of;   // (n) the lowest grain of its fragment
    bool *is_held; // (n) by that grain: never let go
};

struct fragments fragments_new(int n);
void fragments_free(struct fragments *fragments);

// Held are those with a FIXED grain, or where there is none, the largest (the first of
// equals), if it is more than one grain.
void fragments_find(struct fragments *fragments, const struct joint *joint, int n_joint,
                    const uint8_t *fixed, const bool *is_gone);

#endif
