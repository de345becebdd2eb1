// SPDX-License-Identifier: GPL-3.0-or-later
// The balances of a network of conductances: a symmetric positive definite M-matrix.
#ifndef CRAQUELURE_FLOW_MATRIX_H
#define CRAQUELURE_FLOW_MATRIX_H

// Row i reads diagonal_i x_i - sum value_k x_column(k). Columns from N on are places
// where x is given; the solvers take x there to be 0.
struct matrix {
    int n, n_all;
    int *offset;      // (n+1)
    int *column;      // (offset[n])
    double *value;    // (offset[n]) conductances, above 0
    double *diagonal; // (n) their sum in each row, and no more: exact to rounding
};

void matrix_free(struct matrix *matrix);

// RESULT = MATRIX X; both (n), 0 at given places.
void matrix_multiply(const struct matrix *matrix, const double *x, double *result);

#endif
