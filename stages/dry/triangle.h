// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric matrices without their diagonals, of numbers from 0 on, that gain products.
#ifndef CRAQUELURE_TRIANGLE_H
#define CRAQUELURE_TRIANGLE_H

#include <stdbool.h>
#include <stddef.h>

enum { MOST_SOURCES = 64, PANEL = 32 };

// Entries i > j, row by row. Small: packed, doubles. Large: rows come in panels, as
// long as the longest of their panel is with its diagonal block, so that whole vectors
// fit; what stands at and above the diagonal means nothing.
struct triangle {
    bool is_large;
    bool is_rounded; // large: floats
    size_t capacity; // entries
    void *entry;
};

// Where row I begins.
static inline size_t triangle_row(const struct triangle *triangle, int i)
{
    const size_t row = (size_t)i, panel = row / PANEL;
    if (!triangle->is_large) return row * (row - (row > 0)) / 2;
    return (PANEL * panel / 2 + row % PANEL) * PANEL * (panel + 1);
}

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

// Adds sum_k FACTOR[k] SOURCE[k][i] SOURCE[k][j] to each entry of N rows, for at most
// MOST_SOURCES sources; one if the triangle is small.
void triangle_update(struct triangle *triangle, int n, int n_source,
                     const double *factor, const double *const *source);

void triangle_free(struct triangle *triangle);

// What it chooses from if the triangle is large, by its entries and the processor,
// whose vectors make no difference to the digits.
typedef void triangle_kernel(struct triangle *triangle, int n, int n_source,
                             const double *factor, const double *const *source);
triangle_kernel triangle_update_narrow_double, triangle_update_wide_double;
triangle_kernel triangle_update_narrow_float, triangle_update_wide_float;

#endif
