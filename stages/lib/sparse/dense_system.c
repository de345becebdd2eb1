// SPDX-License-Identifier: GPL-3.0-or-later
#include "dense_system.h"

#include "dense_kernels.h"

#include <math.h>

enum { WIDE = 4 }; // columns at a time: the rest is read and written as much less often

static double *row_of(double *matrix, int stride, const int *row, int k)
{
    return matrix + (long)row[k] * stride;
}

// Columns FIRST to END - 1.
static bool factor_panel(int n, double *matrix, int stride, int *row, int first,
                         int end)
{
    for (int k = first; k < end; k++) {
        int best = k;
        for (int r = k + 1; r < n; r++)
            if (fabs(row_of(matrix, stride, row, r)[k]) >
                fabs(row_of(matrix, stride, row, best)[k]))
                best = r;
        const int pivot = row[best];
        row[best] = row[k];
        row[k] = pivot;
        const double *above = row_of(matrix, stride, row, k);
        if (!(fabs(above[k]) > 0)) return false;
        for (int r = k + 1; r < n; r++) {
            double *other = row_of(matrix, stride, row, r);
            other[k] /= above[k];
            for (int l = k + 1; l < end; l++)
                other[l] = fma(-other[k], above[l], other[l]);
        }
    }
    return true;
}

// Takes WIDE rows ABOVE, times what FACTOR says, off ROW.
static void take_off(int first, int n, double *restrict row, const double factor[WIDE],
                     double *const above[WIDE])
{
    const double *const a[WIDE] = {above[0], above[1], above[2], above[3]};
    for (int l = first; l < n; l++)
        row[l] = fma(-factor[3], a[3][l],
                     fma(-factor[2], a[2][l],
                         fma(-factor[1], a[1][l], fma(-factor[0], a[0][l], row[l]))));
}

bool dense_factor(int n, double *matrix, int stride, int *row)
{
    for (int k = 0; k < n; k++)
        row[k] = k;
    for (int first = 0; first < n; first += WIDE) {
        const int end = first + WIDE < n ? first + WIDE : n;
        if (!factor_panel(n, matrix, stride, row, first, end)) return false;
        if (end == n) break;
        double *above[WIDE];
        for (int k = 0; k < WIDE; k++) {
            above[k] = row_of(matrix, stride, row, first + k);
            for (int i = 0; i < k; i++)
                for (int l = end; l < n; l++)
                    above[k][l] = fma(-above[k][first + i], above[i][l], above[k][l]);
        }
        for (int r = end; r < n; r++) {
            double *other = row_of(matrix, stride, row, r);
            take_off(end, n, other, other + first, above);
        }
    }
    return true;
}

void dense_substitute(int n, const double *matrix, int stride, const int *row,
                      const double *right, double *answer)
{
    for (int k = 0; k < n; k++)
        answer[k] =
            right[row[k]] - dot_product(k, matrix + (long)row[k] * stride, answer);
    for (int k = n - 1; k >= 0; k--) {
        const double *upper = matrix + (long)row[k] * stride;
        answer[k] -= dot_product(n - 1 - k, upper + k + 1, answer + k + 1);
        answer[k] /= upper[k];
    }
}
