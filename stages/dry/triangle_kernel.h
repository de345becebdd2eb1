// SPDX-License-Identifier: GPL-3.0-or-later
// Rows times weights added to a triangle: where large fronts spend their time. Included
// with LANES (4 or 8) and UPDATE_NAME, once for each width of vectors. Every entry adds
// its products, fused with the sum, in the order of the sources: the digits are the
// same.
#include "lanes.h"
#include "triangle.h"

#include "basics/memory.h"

#include <stdlib.h>

enum { ROWS = 4, WIDTH = 2 * LANES, BLOCK_COLUMNS = 128 };

// WIDTH columns of ROWS rows at once, in registers.
static inline void add_to_tile(double *const *row, int n_source, const double *weight,
                               const double *const *source, int column)
{
    lanes sum[ROWS][2];
    for (int r = 0; r < ROWS; r++)
        for (int half = 0; half < 2; half++)
            sum[r][half] = load(row[r] + column + half * LANES);
    for (int k = 0; k < n_source; k++) {
        const lanes left = load(source[k] + column);
        const lanes right = load(source[k] + column + LANES);
        for (int r = 0; r < ROWS; r++) {
            sum[r][0] = fused(weight[r * MOST_SOURCES + k], left, sum[r][0]);
            sum[r][1] = fused(weight[r * MOST_SOURCES + k], right, sum[r][1]);
        }
    }
    for (int r = 0; r < ROWS; r++)
        memcpy(row[r] + column, sum[r], sizeof sum[r]);
}

static void add_to_row(double *row, int n_source, const double *weight,
                       const double *const *source, int from, int to)
{
    for (int j = from; j < to; j++)
        for (int k = 0; k < n_source; k++)
            row[j] = fma(weight[k], source[k][j], row[j]);
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

// Columns FIRST..FIRST+BLOCK_COLUMNS-1, which stay in cache. WEIGHT: of each row.
static void add_to_columns(double *triangle, int n, int n_source, const double *weight,
                           const double *const *source, int first)
{
    for (int i = first + 1; i < n; i += ROWS) {
        const int n_row = least(ROWS, n - i);
        double *row[ROWS];
        for (int r = 0; r < n_row; r++)
            row[r] = triangle + triangle_size(i + r);
        const double *own = weight + (size_t)i * MOST_SOURCES;
        const int end = first + BLOCK_COLUMNS;
        int column = first;
        if (n_row == ROWS)
            for (; column + WIDTH <= least(i, end); column += WIDTH)
                add_to_tile(row, n_source, own, source, column);
        for (int r = 0; r < n_row; r++)
            add_to_row(row[r], n_source, own + r * MOST_SOURCES, source, column,
                       least(i + r, end));
    }
}

void UPDATE_NAME(double *triangle, int n, int n_source, const double *factor,
                 const double *const *source)
{
    double *weight = NEW_ARRAY(double, (size_t)n *MOST_SOURCES);
    for (int k = 0; k < n_source; k++)
        for (int i = 0; i < n; i++)
            weight[(size_t)i * MOST_SOURCES + (size_t)k] = factor[k] * source[k][i];
    for (int first = 0; first + 1 < n; first += BLOCK_COLUMNS)
        add_to_columns(triangle, n, n_source, weight, source, first);
    free(weight);
}
