// SPDX-License-Identifier: GPL-3.0-or-later
// The balances of a network of conductances (its graph Laplacian): a symmetric positive
// definite M-matrix once some sites have a given potential. Sites are pores or nodes,
// links throats. With x the potentials (pressures) row i says that the flows sum_k
// value_k (x_column(k) - x_i) balance what is given. All conductances are in one unit,
// potentials in one, flows in their product.
#pragma once

#include "basics/compensated.h"

// A conductance above 0 between two sites, in any unit that all share.
struct link {
    int site[2];
    double conductance;
};

// Row i is diagonal_i x_i - sum value_k x_column(k). Columns from N on are sites where
// x is given; the solvers take x to be 0 there. It owns its arrays. Both directions of
// a link between two unknown sites are there.
struct conductance_matrix {
    int n, n_all;
    int *offset;      // (n+1)
    int *column;      // (offset[n])
    double *value;    // (offset[n]) conductances, above 0
    double *diagonal; // (n) their sum in each row, and no more: exact to rounding
};

// The balances of the first N of N_ALL sites. A row has its links in their order,
// parallel ones separately. The caller frees it with conductance_matrix_free. O(n +
// n_link). Links between two given sites are in no row.
struct conductance_matrix conductance_matrix_of_links(int n, int n_all, int n_link,
                                                      const struct link *link);
void conductance_matrix_free(struct conductance_matrix *matrix);

// RESIDUAL (n) = inflow GIVEN from outside (n; NULL: none) plus the flow along X
// (n_all) to each site, from differences of X: nothing is lost where X is nearly
// constant.
void conductance_matrix_residual(const struct conductance_matrix *matrix,
                                 const double *given, const struct compensated *x,
                                 double *residual);

// RESULT = MATRIX X, both (n), with X 0 at sites where it is given. Not for residuals:
// the diagonal times X cancels where X is nearly constant.
void conductance_matrix_multiply(const struct conductance_matrix *matrix,
                                 const double *x, double *result);
