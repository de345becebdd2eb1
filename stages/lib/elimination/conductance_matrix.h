// SPDX-License-Identifier: GPL-3.0-or-later
// The balances of a network of conductances: a symmetric positive definite M-matrix.
#ifndef CRAQUELURE_CONDUCTANCE_MATRIX_H
#define CRAQUELURE_CONDUCTANCE_MATRIX_H

#include "basics/compensated.h"

struct link {
    int site[2];
    double conductance;
};

// Row i reads diagonal_i x_i - sum value_k x_column(k). Columns from N on are places
// where x is given; the solvers take x there to be 0.
struct matrix {
    int n, n_all;
    int *offset;      // (n+1)
    int *column;      // (offset[n])
    double *value;    // (offset[n]) conductances, above 0
    double *diagonal; // (n) their sum in each row, and no more: exact to rounding
};

// The balances of the first N of N_ALL sites. A row has its links in their order,
// parallel ones apart. The caller frees with matrix_free.
struct matrix matrix_of_links(int n, int n_all, int n_link, const struct link *link);
void matrix_free(struct matrix *matrix);

// What the balances of X (n_all) lack where each site is GIVEN (n; NULL: nothing) from
// outside, into RESIDUAL (n): of differences, so that nothing is lost where X is all
// but even.
void matrix_residual(const struct matrix *matrix, const double *given,
                     const struct compensated *x, double *residual);

// RESULT = MATRIX X; both (n), 0 at given places.
void matrix_multiply(const struct matrix *matrix, const double *x, double *result);

#endif
