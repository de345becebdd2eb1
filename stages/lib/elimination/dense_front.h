// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric matrices without their diagonals, with entries >= 0, that gain products of
// rows with themselves (rank-one updates).
#pragma once

#include "checkpoint/stream.h"

#include <stdbool.h>
#include <stddef.h>

// Updates of doubles, or of floats, that may be pending; rows in a panel; columns in a
// strip of floats, a cache line; bytes of a row in a block of pending rows (72 doubles
// or 144 floats); rows from which on threads share the work. Each entry is one
// thread's, so results do not depend on their number.
enum {
    MAX_PENDING_DOUBLES = 64,
    MAX_PENDING = 128,
    PANEL = 48,
    STRIP = 16,
    BLOCK_BYTES = 576,
    SHARED_FRONT = 1024
};

// Entries i > j, row by row. Small: packed, doubles. Large: rows lie in panels, all as
// long as the longest of their panel with its diagonal block, so that whole vectors
// fit; the entries at and above the diagonal have no meaning. Floats of a panel lie in
// strips of STRIP columns, one row after the other: so a column is read from cache
// lines that follow each other.
//
// The updates of a large one are pending until there are many, and then one pass over
// the entries adds all of them. It owns ENTRY, FACTOR and PENDING. {0} is an empty
// small one.
struct dense_front {
    bool is_large;
    bool is_rounded; // large: floats
    size_t capacity; // entries
    void *entry;

    int n_pending, n_block;
    double *factor; // (n_pending)
    void *pending;  // (n_block, MAX_PENDING or so, BLOCK_BYTES) parts of rows
};

// Index of the first entry of row I, of floats where I begins a panel. With panel = I /
// PANEL, large ones have rows of (panel + 1) PANEL numbers, small ones of I. Numbers
// before row I: I (I - 1) / 2 where packed; else those of the panels before, and of the
// rows of the own panel.
static inline size_t dense_front_row(const struct dense_front *dense, int i)
{
    const size_t row = (size_t)i, panel = row / PANEL;
    if (!dense->is_large) return row * (row - (row > 0)) / 2;
    return (PANEL * panel / 2 + row % PANEL) * PANEL * (panel + 1);
}

// From column 0 to column J in a row of floats.
static inline size_t dense_front_strip_column(int j)
{
    return (size_t)(j / STRIP) * PANEL * STRIP + (size_t)(j % STRIP);
}

// Index of entry (I, J) of floats.
static inline size_t dense_front_in_strip(const struct dense_front *dense, int i, int j)
{
    const int in_panel = i % PANEL;
    return dense_front_row(dense, i - in_panel) + (size_t)in_panel * STRIP +
           dense_front_strip_column(j);
}

static inline size_t dense_front_at(const struct dense_front *dense, int i, int j)
{
    return dense->is_rounded ? dense_front_in_strip(dense, i, j)
                             : dense_front_row(dense, i) + (size_t)j;
}

// Number AT of the entries, in double precision, whatever they are.
static inline double dense_front_number(const struct dense_front *dense, size_t at)
{
    return dense->is_rounded ? (double)((float *)dense->entry)[at]
                             : ((double *)dense->entry)[at];
}

// Entry (I, J), J < I, without pending updates.
static inline double dense_front_entry(const struct dense_front *dense, int i, int j)
{
    return dense_front_number(dense, dense_front_at(dense, i, j));
}

// Entry (I, J), J < I, becomes X, rounded where entries are floats.
static inline void dense_front_set(struct dense_front *dense, int i, int j, double x)
{
    const size_t at = dense_front_at(dense, i, j);
    if (dense->is_rounded)
        ((float *)dense->entry)[at] = (float)x;
    else
        ((double *)dense->entry)[at] = x;
}

// Adds row N, of zeros, to N rows. Room grows by half, so that many rows cost little
// more than their entries.
void dense_front_add_row(struct dense_front *dense, int n);

// Takes row and column P of N rows out into ROW (n), pending updates included; 0 at P.
// Those of the last row, which goes, take their place, in the pending rows too. So
// whoever numbers the rows must move its last one. O(n + n n_pending).
void dense_front_take_row(struct dense_front *dense, int n, int p, double *row);

// Turns a small one of N rows into a large one, whose entries are floats if it IS
// ROUNDED: half the memory, seven digits. It stays large when rows go.
void dense_front_enlarge(struct dense_front *dense, int n, bool is_rounded);

// Adds FACTOR ROW[i] ROW[j] to each entry of N rows. Small: at once, O(n^2). Large:
// kept, until so many of them are pending that one pass over memory adds all.
void dense_front_add_products(struct dense_front *dense, int n, double factor,
                              const double *row);

// Adds all pending updates to the entries.
void dense_front_flush(struct dense_front *dense, int n);

// Keeps or restores N rows, entries and pending updates as they are; large ones are
// floats if it IS ROUNDED. Pending ones are not flushed for it, as that would change
// the rounding of what follows.
void dense_front_state(struct dense_front *dense, int n, bool is_rounded,
                       struct checkpoint_stream *stream);

// What it owns; it is empty then.
void dense_front_free(struct dense_front *dense);

// Kernels of large fronts by type of entry and processor; the digits are the same. A
// pass adds all pending updates to the entries. A gather adds WEIGHT (n_pending) times
// the pending rows to ROW (n).
typedef void dense_front_pass(struct dense_front *dense, int n);
typedef void dense_front_gather(const struct dense_front *dense, int n,
                                const double *weight, double *row);
dense_front_pass dense_front_pass_avx2_double, dense_front_pass_avx512_double;
dense_front_pass dense_front_pass_avx2_float, dense_front_pass_avx512_float;
dense_front_gather dense_front_gather_avx2_double, dense_front_gather_avx512_double;
dense_front_gather dense_front_gather_avx2_float, dense_front_gather_avx512_float;
