// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels in which factors spend their time, for the vectors of this processor.
// Each number has the same digits with AVX2 and AVX-512. Panels of supernodes are as in
// supernodal_internal.h; eight right-hand sides lie side by side, row i at x[i BATCH].
// Why a table of functions: the files for AVX2 and AVX-512 are compiled from one
// template (vector_kernels_template.h), and which of them a processor can run is known
// only at run time.
#pragma once

#include "basics/cpu_features.h"
#include "supernodal.h"

struct supernode;

enum { PACKED = 48 }; // columns of B that multiply_transposed takes together

// None allocates or fails.
struct vector_kernels {
    // X (n * BATCH), in the order of the factor, becomes L^-1 X as far as SUPER is
    // concerned.
    void (*forward_eight)(const struct supernode *super, double *x);
    // Divides the rows below END of the columns FIRST to END - 1, at most eight, by the
    // triangle of these columns.
    void (*finish_columns)(const struct supernode *super, int first, int end);
    // SUM += A^T B, over N rows: one, four or eight columns (lanes) of A, eight of B.
    void (*add_product_of_eight)(int n, const double *a, int a_lanes, const double *b,
                                 double sum[BATCH][BATCH]);
    // See dense_kernels.h.
    void (*multiply_transposed)(int m, int n, int k, const double *a, int a_stride,
                                const double *b, int b_stride, double *c, int c_stride,
                                bool lower, double *work);
    // See dense_factor in dense_lu.h.
    bool (*factor_dense)(int n, double *matrix, int stride, int *row, double *work);
};
extern const struct vector_kernels vector_kernels_avx2, vector_kernels_avx512;

// Those of this processor. It may be asked for as often as wanted.
static inline const struct vector_kernels *vector_kernels(void)
{
    return has_avx512() ? &vector_kernels_avx512 : &vector_kernels_avx2;
}

// The same for four lanes, row i at x[4 i]; the products fill four columns of SUM. One
// version serves all processors. Four columns are one vector of AVX2; AVX-512 would
// gain nothing. X (4 n).
void forward_four(const struct supernode *super, double *x);
void add_product_of_four(int n, const double *a, int a_lanes, const double *b,
                         double sum[BATCH][BATCH]);
