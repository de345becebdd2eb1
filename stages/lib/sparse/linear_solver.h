// SPDX-License-Identifier: GPL-3.0-or-later
// What is added to the pressures so that balances close: by Cholesky's factor, or by
// conjugate gradients with a sampled factor.
#ifndef CRAQUELURE_LINEAR_SOLVER_H
#define CRAQUELURE_LINEAR_SOLVER_H

#include "cholesky.h"
#include "elimination/approximate_cholesky.h"
#include "elimination/conductance_matrix.h"

enum solver { SOLVER_AUTO, SOLVER_CHOLESKY, SOLVER_ITERATION };

struct linear_solver {
    const struct matrix *matrix;
    struct cholesky *cholesky; // one of the two, the other NULL
    struct sampled_factor *factor;
    double *correction;         // (n)
    double *residual, *work[3]; // (n) of conjugate gradients
};

// The matrix must outlive it. The caller frees with linear_solver_free, also after an
// error.
enum status linear_solver_make(const struct matrix *matrix, enum solver solver,
                               struct linear_solver *linear, struct reason *reason);
void linear_solver_free(struct linear_solver *linear);

// Corrects X (n_all) by what the balances RESIDUAL (n), as matrix_residual found with
// GIVEN, and finds anew what they lack. Conjugate gradients take it down to REDUCTION
// of that of no correction, or as far as they come, and add to ITERATIONS; after the
// first call they go on from their last direction. STATUS_INTERNAL: no memory.
enum status linear_correct(struct linear_solver *linear, const double *given,
                           struct compensated *x, double *residual, double reduction,
                           int *iterations, struct reason *reason);

#endif
