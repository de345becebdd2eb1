// SPDX-License-Identifier: GPL-3.0-or-later
// Products of rows added to a block: where large fronts spend their time. Included with
// LANES (4 or 8), ROWS and UPDATE_NAME, once for each width of vectors. Every entry
// adds its products, fused with the sum, in the order of the sources: the digits are
// the same.
#include "lanes.h"
#include "sheet.h"

static inline void store(lanes value, double *to)
{
    memcpy(to, &value, sizeof value);
}

// Two vectors of each of ROWS rows at once, in registers.
static inline void add_to_tile(double *tile, int n_source, const double *const *left,
                               const double *const *right, int row, int column)
{
    lanes sum[ROWS][2];
    for (int r = 0; r < ROWS; r++)
        for (int half = 0; half < 2; half++)
            sum[r][half] = load(tile + r * PATCH + half * LANES);
    for (int k = 0; k < n_source; k++) {
        const double *weight = left[k] + row;
        const lanes first = load(right[k] + column);
        const lanes second = load(right[k] + column + LANES);
        for (int r = 0; r < ROWS; r++) {
            sum[r][0] = fused(weight[r], first, sum[r][0]);
            sum[r][1] = fused(weight[r], second, sum[r][1]);
        }
    }
    for (int r = 0; r < ROWS; r++)
        for (int half = 0; half < 2; half++)
            store(sum[r][half], tile + r * PATCH + half * LANES);
}

void UPDATE_NAME(double *block, int n_row, int n_column, int n_source,
                 const double *const *left, const double *const *right)
{
    for (int i = 0; i < n_row; i += ROWS)
        for (int j = 0; j < n_column; j += 2 * LANES)
            add_to_tile(block + i * PATCH + j, n_source, left, right, i, j);
}
