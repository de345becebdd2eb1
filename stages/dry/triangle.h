// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric matrices without their diagonals: entries i > j at i(i-1)/2 + j.
#ifndef CRAQUELURE_TRIANGLE_H
#define CRAQUELURE_TRIANGLE_H

#include <stddef.h>

enum { MOST_SOURCES = 32 };

static inline size_t triangle_size(int n)
{
    return n > 0 ? (size_t)n * (size_t)(n - 1) / 2 : 0;
}

// Adds sum_k FACTOR[k] SOURCE[k][i] SOURCE[k][j] to each entry of the triangle of N
// rows, for at most MOST_SOURCES sources.
void triangle_update(double *triangle, int n, int n_source, const double *factor,
                     const double *const *source);

// What it chooses from, by the processor: the same digits.
void triangle_update_narrow(double *triangle, int n, int n_source, const double *factor,
                            const double *const *source);
void triangle_update_wide(double *triangle, int n, int n_source, const double *factor,
                          const double *const *source);

#endif
