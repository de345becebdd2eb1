// SPDX-License-Identifier: GPL-3.0-or-later
// Dispatch of the dense product C = A B^T to the kernel of this processor. The table of
// kernels is chosen at run time, once for each call, since a build serves processors
// with AVX2 and with AVX-512 (vector_kernels.h).
#include "dense_kernels.h"

#include "vector_kernels.h"

void multiply_transposed(int m, int n, int k, const double *a, int a_stride,
                         const double *b, int b_stride, double *c, int c_stride,
                         bool lower, double *work)
{
    vector_kernels()->multiply_transposed(m, n, k, a, a_stride, b, b_stride, c,
                                          c_stride, lower, work);
}
