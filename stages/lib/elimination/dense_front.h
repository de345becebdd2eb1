// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric matrices without their diagonals, of numbers from 0 on, that gain products
// of rows with themselves.
#ifndef CRAQUELURE_TRIANGLE_H
#define CRAQUELURE_TRIANGLE_H

#include "checkpoint/stream.h"

#include <stdbool.h>
#include <stddef.h>

enum { MOST_SOURCES = 64, PANEL = 48, BLOCK_BYTES = 576 };

// Entries i > j, row by row. Small: packed, doubles. Large: rows come in panels, as
// long as the longest of their panel is with its diagonal block, so that whole vectors
// fit; what stands at and above the diagonal means nothing.
//
// What a large one gains waits until there is much, and then passes over the entries
// once for all.
struct triangle {
    bool is_large;
    bool is_rounded; // large: floats
    size_t capacity; // entries
    void *entry;

    int n_waiting, n_block;
    double *factor; // (n_waiting)
    void *waiting;  // (n_block, MOST_SOURCES, BLOCK_BYTES) parts of rows
};

// Where row I begins.
static inline size_t triangle_row(const struct triangle *triangle, int i)
{
    const size_t row = (size_t)i, panel = row / PANEL;
    if (!triangle->is_large) return row * (row - (row > 0)) / 2;
    return (PANEL * panel / 2 + row % PANEL) * PANEL * (panel + 1);
}

// Without what waits.
static inline double triangle_entry(const struct triangle *triangle, int i, int j)
{
    const size_t at = triangle_row(triangle, i) + (size_t)j;
    return triangle->is_rounded ? (double)((float *)triangle->entry)[at]
                                : ((double *)triangle->entry)[at];
}

static inline void triangle_set(struct triangle *triangle, int i, int j, double x)
{
    const size_t at = triangle_row(triangle, i) + (size_t)j;
    if (triangle->is_rounded)
        ((float *)triangle->entry)[at] = (float)x;
    else
        ((double *)triangle->entry)[at] = x;
}

// Of N rows before: one more, of zeros.
void triangle_add_row(struct triangle *triangle, int n);

// Entries P of all N rows, and row P; 0 at P itself.
void triangle_take(const struct triangle *triangle, int n, int p, double *row);

// Row and column P become those of the last of N rows, which goes.
void triangle_remove(struct triangle *triangle, int n, int p);

// From small to large.
void triangle_enlarge(struct triangle *triangle, int n, bool is_rounded);

// Adds FACTOR ROW[i] ROW[j] to each entry of N rows.
void triangle_add_products(struct triangle *triangle, int n, double factor,
                           const double *row);

// Nothing waits any more.
void triangle_bring_up_to_date(struct triangle *triangle, int n);

// Of N rows, none of them rounded.
void triangle_state(struct triangle *triangle, int n, struct checkpoint_stream *stream);

void triangle_free(struct triangle *triangle);

// What it chooses from if the triangle is large, by its entries and the processor,
// whose vectors make no difference to the digits: all that waits is added to the
// entries; WEIGHT (n_waiting) times what waits is added to ROW (n).
typedef void triangle_pass(struct triangle *triangle, int n);
typedef void triangle_gather(const struct triangle *triangle, int n,
                             const double *weight, double *row);
triangle_pass triangle_pass_narrow_double, triangle_pass_wide_double;
triangle_pass triangle_pass_narrow_float, triangle_pass_wide_float;
triangle_gather triangle_gather_narrow_double, triangle_gather_wide_double;
triangle_gather triangle_gather_narrow_float, triangle_gather_wide_float;

#endif
