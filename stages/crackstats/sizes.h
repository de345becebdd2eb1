// SPDX-License-Identifier: GPL-3.0-or-later
// Sizes of clusters or fragments, collected over runs: one number each, in broken bonds
// or grains, in the order in which they are found, run after run. The report sorts them
// and counts equal ones.
#pragma once

#include "basics/memory.h"

// An empty one is {0}.
struct sizes {
    int *size; // (count) the caller frees it
    int count, capacity;
};

// Appends SIZE; O(1) on average.
static inline void add_size(struct sizes *sizes, int size)
{
    GROW_ARRAY(sizes->size, sizes->count, sizes->capacity);
    sizes->size[sizes->count++] = size;
}
