// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense products. Columns lie STRIDE apart: entry (i, p) of A at a[p a_stride +
// i]. Products are fused and summed in the same order on every machine.
#pragma once

#include "basics/simd.h"

// sum a_i b_i over N numbers at any address: eight running sums, of i mod 8, added at
// the end; then the rest one by one. The order of the additions is part of the result:
// two vectors of four sums, then pairs of them. N may be 0.
static inline double dot_product(int n, const double *a, const double *b)
{
    double4 sum[2] = {{0}};
    int i = 0;
    for (; i + 8 <= n; i += 8)
        for (long k = 0; k < 2; k++)
            sum[k] = fmadd(load_unaligned(a + i + 4 * k), load_unaligned(b + i + 4 * k),
                           sum[k]);
    const double4 both = sum[0] + sum[1];
    double total = (both[0] + both[1]) + (both[2] + both[3]);
    for (; i < n; i++)
        total = fma(a[i], b[i], total);
    return total;
}

// C (m by n) = A (m by k) B (n by k)^T; of a square C at least the lower triangle where
// LOWER. WORK (PACKED k), see vector_kernels.h. Reads up to seven numbers past the end
// of A and ignores them. The kernel is that of the processor (vector_kernels.h), with
// the same digits on all. 2 m n k operations; C is overwritten. C must be apart from A
// and B.
void multiply_transposed(int m, int n, int k, const double *a, int a_stride,
                         const double *b, int b_stride, double *c, int c_stride,
                         bool lower, double *work);
