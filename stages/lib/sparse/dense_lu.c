// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense systems A x = b: the factor by the kernel of this processor
// (dense_lu_kernel.h), the substitution here. With P A = L U in rows ROW of the matrix,
//     y_k = b_row(k) - L_k . y,        k = 0 .. n - 1,
//     x_k = (y_k - U_k . x) / U_kk,    k = n - 1 .. 0,  in place of y.
// L has ones on its diagonal. Both go by rows, where numbers are contiguous, and their
// sums by dot_product, whose order of additions is the same on all processors. Source:
// Golub and Van Loan, Matrix Computations, 3.1 and 3.4.
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
