// SPDX-License-Identifier: GPL-3.0-or-later
// What most of the work on factors is done by, for the vectors that the processor has.
#ifndef CRAQUELURE_VECTOR_KERNELS_H
#define CRAQUELURE_VECTOR_KERNELS_H

#include "basics/cpu_features.h"
#include "supernodal.h"

struct supernode;

enum { PACKED = 48 }; // columns of B that multiply_transposed takes together

struct vector_kernels {
    // X (n * BATCH), in the order of the factor, as far as SUPER is concerned: becomes
    // L^-1 X.
    void (*forward_eight)(const struct supernode *super, double *x);
    // The rows below END of the columns FIRST to END - 1, eight at most, of a panel
    // that is done with so far.
    void (*finish_columns)(const struct supernode *super, int first, int end);
    // SUM grows by A^T B, (n) rows of lanes, one, four or eight of A, eight of B.
    void (*add_product_of_eight)(int n, const double *a, int a_lanes, const double *b,
                                 double sum[BATCH][BATCH]);
    // As dense_kernels.h says.
    void (*multiply_transposed)(int m, int n, int k, const double *a, int a_stride,
                                const double *b, int b_stride, double *c, int c_stride,
                                bool lower, double *work);
    // As dense_lu.h says of dense_factor.
    bool (*factor_dense)(int n, double *matrix, int stride, int *row, double *work);
};
extern const struct vector_kernels vector_kernels_avx2, vector_kernels_avx512;

static inline const struct vector_kernels *vector_kernels(void)
{
    return has_avx512() ? &vector_kernels_avx512 : &vector_kernels_avx2;
}

// Of four lanes.
void forward_four(const struct supernode *super, double *x);
void add_product_of_four(int n, const double *a, int a_lanes, const double *b,
                         double sum[BATCH][BATCH]);

#endif
