// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of a load from an array of all.
#pragma once

#include "dem-replay/replay.h"

// The .source of a load whose .force is row_in_memory.
struct rows_in_memory {
    struct vector *force; // (n_time * n)
    int n;                // grains
};

static inline const struct vector *row_in_memory(void *rows, int row)
{
    const struct rows_in_memory *of = rows;
    return of->force + (ptrdiff_t)row * of->n;
}
