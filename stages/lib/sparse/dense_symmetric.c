// SPDX-License-Identifier: GPL-3.0-or-later
#include "dense_symmetric.h"

#include "dense_kernels.h"

#include <math.h>

enum { WIDE = 8 }; // columns at a time: the rest is read as much less often

// Takes what the columns before FIRST say off the rows from BEGIN on of those from
// FIRST to END - 1.
static void update(int n, double *matrix, int stride, const double *sign, int first,
                   int end, int begin, double *work)
{
    double *product = work, *sided = work + 8 * n, *packed = work + 16 * n;
    for (int p = 0; p < first; p++)
        for (int j = 0; j < WIDE; j++)
            sided[WIDE * p + j] =
                first + j < end ? sign[p] * matrix[(long)p * stride + first + j] : 0;
    multiply_transposed(n - begin, end - first, first, matrix + begin, stride, sided,
                        WIDE, product, n, begin == first, packed);
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

bool dense_symmetric_factor(int n, int done, double *matrix, int stride,
                            const double *sign, double *work)
{
    const int kept = dense_symmetric_kept(done);
    for (int first = 0; first < n; first += WIDE) {
        const int end = first + WIDE < n ? first + WIDE : n;
        const int begin = first < kept ? done : first;
        if (begin == n) continue;
        if (first > 0) update(n, matrix, stride, sign, first, end, begin, work);
        if (!factor_columns(n, matrix, stride, sign, first, end, begin)) return false;
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
