// SPDX-License-Identifier: GPL-3.0-or-later
#include "dense_symmetric.h"

#include "dense_kernels.h"
#include "vector_kernels.h"

#include <assert.h>
#include <math.h>

// Columns at a time, and of them again: the rest is read as much less often.
enum { WIDE = 8, PANEL = PACKED };

static_assert(DENSE_SYMMETRIC_WORK == 3 * PANEL, "three panels");

// Takes what the columns from FROM to TO - 1 say off the rows from BEGIN on of those
// from FIRST to END - 1.
static void update(int n, double *matrix, int stride, const double *sign, int from,
                   int to, int first, int end, int begin, double *work)
{
    const int columns = to - from, wide = end - first;
    if (columns == 0 || wide <= 0 || begin >= n) return;
    double *product = work, *sided = work + PANEL * n, *packed = sided + PANEL * n;
    const double *panel = matrix + (long)from * stride;
    for (int p = 0; p < columns; p++)
        for (int j = 0; j < wide; j++)
            sided[wide * p + j] = sign[from + p] * panel[(long)p * stride + first + j];
    multiply_transposed(n - begin, wide, columns, panel + begin, stride, sided, wide,
                        product, n, begin == first, packed);
    for (int j = first; j < end; j++)
        for (int i = begin > j ? begin : j; i < n; i++)
            matrix[(long)j * stride + i] -= product[(long)(j - first) * n + i - begin];
}

// The rows from BEGIN on; those before are done with where that is not FIRST.
static bool factor_columns(int n, double *matrix, int stride, const double *sign,
                           int first, int end, int begin)
{
    for (int j = first; j < end; j++) {
        double *column = matrix + (long)j * stride;
        if (begin <= j) {
            if (!(sign[j] * column[j] > 0)) return false;
            column[j] = sqrt(sign[j] * column[j]);
        }
        const double pivot = sign[j] * column[j];
        for (int i = begin > j ? begin : j + 1; i < n; i++)
            column[i] /= pivot;
        for (int l = j + 1; l < end; l++) {
            double *other = matrix + (long)l * stride;
            for (int i = begin > l ? begin : l; i < n; i++)
                other[i] = fma(-sign[j] * column[l], column[i], other[i]);
        }
    }
    return true;
}

int dense_symmetric_kept(int done)
{
    return done - done % WIDE;
}

static int clamp(int k, int low, int high)
{
    return k < low ? low : k < high ? k : high;
}

bool dense_symmetric_factor(int n, int done, double *matrix, int stride,
                            const double *sign, double *work)
{
    const int kept = dense_symmetric_kept(done);
    for (int panel = 0; panel < n; panel += PANEL) {
        const int last = clamp(panel + PANEL, 0, n), split = clamp(kept, panel, last);
        update(n, matrix, stride, sign, 0, panel, panel, split, done, work);
        update(n, matrix, stride, sign, 0, panel, split, last, split, work);
        for (int first = panel; first < last; first += WIDE) {
            const int end = clamp(first + WIDE, 0, last);
            const int begin = first < kept ? done : first;
            if (begin == n) continue;
            update(n, matrix, stride, sign, panel, first, first, end, begin, work);
            if (!factor_columns(n, matrix, stride, sign, first, end, begin))
                return false;
        }
    }
    return true;
}

void dense_symmetric_solve(int n, const double *matrix, int stride, const double *sign,
                           double *x)
{
    for (int j = 0; j < n; j++) {
        const double *restrict column = matrix + (long)j * stride;
        x[j] /= column[j];
        const double minus = -x[j];
        for (int i = j + 1; i < n; i++)
            x[i] = fma(column[i], minus, x[i]);
    }
    for (int j = n - 1; j >= 0; j--) {
        const double *column = matrix + (long)j * stride;
        x[j] = sign[j] * x[j] - dot_product(n - 1 - j, column + j + 1, x + j + 1);
        x[j] /= column[j];
    }
}
