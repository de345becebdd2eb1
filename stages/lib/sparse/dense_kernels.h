// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense products, columns one after the other, STRIDE apart: four numbers at a
// time, summed in the same order and rounded once a product whatever the machine.
#ifndef CRAQUELURE_DENSE_KERNELS_H
#define CRAQUELURE_DENSE_KERNELS_H

#include <math.h>
#include <stdbool.h>
#if defined __x86_64__ && defined __FMA__
#include <immintrin.h>
#endif

typedef double four __attribute__((vector_size(32), aligned(8), may_alias));

static inline four load_four(const double *from)
{
    return *(const four *)from;
}

// A B + C, written out, as compilers do not contract alike.
static inline four fused(four a, four b, four c)
{
#if defined __x86_64__ && defined __FMA__
    return (four)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#else
    for (int k = 0; k < 4; k++)
        c[k] = fma(a[k], b[k], c[k]);
    return c;
#endif
}

static inline double dot_product(int n, const double *a, const double *b)
{
    four sum[2] = {{0}};
    int i = 0;
    for (; i + 8 <= n; i += 8)
        for (int k = 0; k < 2; k++)
            sum[k] = fused(load_four(a + i + 4 * k), load_four(b + i + 4 * k), sum[k]);
    const four both = sum[0] + sum[1];
    double total = (both[0] + both[1]) + (both[2] + both[3]);
    for (; i < n; i++)
        total = fma(a[i], b[i], total);
    return total;
}

// C (m by n) = A (m by k) B (n by k)^T, of a square C at least the lower triangle where
// LOWER. WORK (PACKED k), of vector_kernels.h. Seven numbers beyond those of A are
// read, whatever they are.
void multiply_transposed(int m, int n, int k, const double *a, int a_stride,
                         const double *b, int b_stride, double *c, int c_stride,
                         bool lower, double *work);

#endif
