// SPDX-License-Identifier: GPL-3.0-or-later
// Dispatch of the dense factor, and its substitution: with P A = L U in rows ROW,
//     y_k = b_row(k) - L_k . y,   x_k = (y_k - U_k . x) / U_kk backwards.
#include "dense_lu.h"

#include "dense_kernels.h"

#include "vector_kernels.h"

bool dense_factor(int n, double *matrix, int stride, int *row, double *work)
{
    return vector_kernels()->factor_dense(n, matrix, stride, row, work);
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
