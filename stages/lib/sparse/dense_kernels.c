// SPDX-License-Identifier: GPL-3.0-or-later
// Dispatch of the dense product to the kernel of this processor.
#include "dense_kernels.h"

#include "vector_kernels.h"

void multiply_transposed(int m, int n, int k, const double *a, int a_stride,
                         const double *b, int b_stride, double *c, int c_stride,
                         bool lower, double *work)
{
    vector_kernels()->multiply_transposed(m, n, k, a, a_stride, b, b_stride, c,
                                          c_stride, lower, work);
}
