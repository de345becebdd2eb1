// SPDX-License-Identifier: GPL-3.0-or-later
// A preconditioner of the balances of a gas that has grown since their factor was made
// (multiplicative Schwarz): Gauss-Seidel over the rows that the factor does not know
// and those linked to them, the factor, and Gauss-Seidel backwards.
#pragma once

#include "elimination/approximate_cholesky.h"

// It owns its arrays, but neither matrix nor factor.
struct gas_preconditioner {
    const struct conductance_matrix *matrix;
    struct approximate_cholesky *factor; // of the first rows
    int n_factor, n_near;
    int *near;                  // (n_near) rows that Gauss-Seidel visits
    double *rest, *from_factor; // (n), (n_factor)
};

// FACTOR is that of the first N_FACTOR rows of MATRIX. The caller frees it with
// gas_preconditioner_free.
struct gas_preconditioner gas_preconditioner_of(const struct conductance_matrix *matrix,
                                                struct approximate_cholesky *factor,
                                                int n_factor);
void gas_preconditioner_free(struct gas_preconditioner *gas);

// Z (n) = M^-1 B (n), symmetric and positive definite. B as approximate_cholesky_apply
// wants it.
void gas_preconditioner_apply(const struct gas_preconditioner *gas, const double *b,
                              double *z);
