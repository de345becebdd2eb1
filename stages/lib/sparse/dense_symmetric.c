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

// Rows of the columns from FIRST to END - 1 themselves.
static bool factor_triangle(double *matrix, int stride, const double *sign, int first,
                            int end)
{
    for (int j = first; j < end; j++) {
        double *column = matrix + (long)j * stride;
        if (!(sign[j] * column[j] > 0)) return false;
        const double inverse = 1 / sqrt(sign[j] * column[j]);
        column[j] = inverse;
        for (int i = j + 1; i < end; i++)
            column[i] *= sign[j] * inverse;
        for (int l = j + 1; l < end; l++)
            for (int i = l; i < end; i++)
                matrix[(long)l * stride + i] =
                    fma(-sign[j] * column[l], column[i], matrix[(long)l * stride + i]);
    }
    return true;
}

// The rows of WIDE columns from BEGIN on, below that.
static inline __attribute__((always_inline)) void
finish_rows(int n, double *matrix, int stride, const double *sign, int wide, int begin,
            int triangle)
{
    double share[WIDE][WIDE], inverse[WIDE];
    for (int j = 0; j < wide; j++) {
        for (int l = 0; l < j; l++)
            share[j][l] = -sign[l] * matrix[(long)l * stride + triangle + j];
        inverse[j] = sign[j] * matrix[(long)j * stride + triangle + j];
    }
    int i = begin;
    for (; i + 4 <= n; i += 4) {
        four x[WIDE];
        for (int j = 0; j < wide; j++) {
            x[j] = load_four(matrix + (long)j * stride + i);
            for (int l = 0; l < j; l++)
                x[j] = fused(all_four(share[j][l]), x[l], x[j]);
            x[j] *= all_four(inverse[j]);
            store_four(matrix + (long)j * stride + i, x[j]);
        }
    }
    for (; i < n; i++)
        for (int j = 0; j < wide; j++) {
            double x = matrix[(long)j * stride + i];
            for (int l = 0; l < j; l++)
                x = fma(share[j][l], matrix[(long)l * stride + i], x);
            matrix[(long)j * stride + i] = x * inverse[j];
        }
}

// The rows from BEGIN on; those before are done with where that is not FIRST.
static bool factor_columns(int n, double *matrix, int stride, const double *sign,
                           int first, int end, int begin)
{
    double *columns = matrix + (long)first * stride;
    if (begin == first && !factor_triangle(matrix, stride, sign, first, end))
        return false;
    if (begin == first) begin = end;
    if (end - first == WIDE)
        finish_rows(n, columns, stride, sign + first, WIDE, begin, first);
    else
        finish_rows(n, columns, stride, sign + first, end - first, begin, first);
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

// Some columns of L at a time, so that X is read as much less often.
static inline __attribute__((always_inline)) void
forward(int n, const double *matrix, int stride, int j, int wide, double *restrict x)
{
    const double *restrict column = matrix + (long)j * stride;
    four all[4];
    for (int k = 0; k < wide; k++) {
        for (int l = 0; l < k; l++)
            x[j + k] = fma(-column[(long)l * stride + j + k], x[j + l], x[j + k]);
        x[j + k] *= column[(long)k * stride + j + k];
        all[k] = all_four(-x[j + k]);
    }
    int i = j + wide;
    for (; i + 4 <= n; i += 4) {
        four left = load_four(x + i);
        for (int k = 0; k < wide; k++)
            left = fused(load_four(column + (long)k * stride + i), all[k], left);
        store_four(x + i, left);
    }
    for (; i < n; i++)
        for (int k = 0; k < wide; k++)
            x[i] = fma(column[(long)k * stride + i], all[k][0], x[i]);
}

static inline __attribute__((always_inline)) void
backward(int n, const double *matrix, int stride, int j, int wide, double *restrict x)
{
    const double *restrict column = matrix + (long)j * stride;
    four sum[4] = {{0}};
    double own[4];
    int i = j + wide;
    for (; i + 4 <= n; i += 4)
        for (int k = 0; k < wide; k++)
            sum[k] = fused(load_four(column + (long)k * stride + i), load_four(x + i),
                           sum[k]);
    for (int k = 0; k < wide; k++)
        own[k] = x[j + k] - ((sum[k][0] + sum[k][1]) + (sum[k][2] + sum[k][3]));
    for (; i < n; i++)
        for (int k = 0; k < wide; k++)
            own[k] = fma(-column[(long)k * stride + i], x[i], own[k]);
    for (int k = wide - 1; k >= 0; k--) {
        for (int l = k + 1; l < wide; l++)
            own[k] = fma(-column[(long)k * stride + j + l], x[j + l], own[k]);
        x[j + k] = own[k] * column[(long)k * stride + j + k];
    }
}

void dense_symmetric_solve(int n, const double *matrix, int stride, const double *sign,
                           double *x)
{
    int j = 0;
    for (; j + 4 <= n; j += 4)
        forward(n, matrix, stride, j, 4, x);
    for (; j < n; j++)
        forward(n, matrix, stride, j, 1, x);
    for (int k = 0; k < n; k++)
        x[k] *= sign[k];
    while (j % 4)
        backward(n, matrix, stride, --j, 1, x);
    while (j > 0)
        backward(n, matrix, stride, j -= 4, 4, x);
}
