// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric matrices without their diagonals, of numbers from 0 on, that gain products
// of rows with themselves.
#ifndef CRAQUELURE_DENSE_FRONT_H
#define CRAQUELURE_DENSE_FRONT_H

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
struct dense_front {
    bool is_large;
    bool is_rounded; // large: floats
    size_t capacity; // entries
    void *entry;

    int n_waiting, n_block;
    double *factor; // (n_waiting)
    void *waiting;  // (n_block, MOST_SOURCES, BLOCK_BYTES) parts of rows
};

// Where row I begins.
static inline size_t dense_front_row(const struct dense_front *dense, int i)
{
    const size_t row = (size_t)i, panel = row / PANEL;
    if (!dense->is_large) return row * (row - (row > 0)) / 2;
    return (PANEL * panel / 2 + row % PANEL) * PANEL * (panel + 1);
}

// Without what waits.
static inline double dense_front_entry(const struct dense_front *dense, int i, int j)
{
    const size_t at = dense_front_row(dense, i) + (size_t)j;
    return dense->is_rounded ? (double)((float *)dense->entry)[at]
                             : ((double *)dense->entry)[at];
}

static inline void dense_front_set(struct dense_front *dense, int i, int j, double x)
{
    const size_t at = dense_front_row(dense, i) + (size_t)j;
    if (dense->is_rounded)
        ((float *)dense->entry)[at] = (float)x;
    else
        ((double *)dense->entry)[at] = x;
}

// Of N rows before: one more, of zeros.
void dense_front_add_row(struct dense_front *dense, int n);

// Entries P of all N rows, and row P; 0 at P itself.
void dense_front_take(const struct dense_front *dense, int n, int p, double *row);

// Row and column P become those of the last of N rows, which goes.
void dense_front_remove(struct dense_front *dense, int n, int p);

// From small to large.
void dense_front_enlarge(struct dense_front *dense, int n, bool is_rounded);

// Adds FACTOR ROW[i] ROW[j] to each entry of N rows.
void dense_front_add_products(struct dense_front *dense, int n, double factor,
                              const double *row);

// Nothing waits any more.
void dense_front_bring_up_to_date(struct dense_front *dense, int n);

// Of N rows, none of them rounded.
void dense_front_state(struct dense_front *dense, int n,
                       struct checkpoint_stream *stream);

void dense_front_free(struct dense_front *dense);

// What it chooses from if the triangle is large, by its entries and the processor,
// whose vectors make no difference to the digits: all that waits is added to the
// entries; WEIGHT (n_waiting) times what waits is added to ROW (n).
typedef void dense_front_pass(struct dense_front *dense, int n);
typedef void dense_front_gather(const struct dense_front *dense, int n,
                                const double *weight, double *row);
dense_front_pass dense_front_pass_avx2_double, dense_front_pass_avx512_double;
dense_front_pass dense_front_pass_avx2_float, dense_front_pass_avx512_float;
dense_front_gather dense_front_gather_avx2_double, dense_front_gather_avx512_double;
dense_front_gather dense_front_gather_avx2_float, dense_front_gather_avx512_float;

#endif
