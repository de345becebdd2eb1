// SPDX-License-Identifier: GPL-3.0-or-later
// Corrections of potentials until the balances of a network close: with a Cholesky
// factor, or by conjugate gradients preconditioned with an approximate one. X is kept
// as compensated sums and corrected again and again (iterative refinement): each
// correction is solved to a few digits, while the residual is computed with all of
// them. So flows keep their digits where potentials are nearly equal.
//
// The loop that a caller writes; the first correction is nearly the solution:
//     conductance_matrix_residual(&matrix, given, x, residual);
//     for (int k = 0; size_of(residual) > tolerance && k < most; k++)
//         status = linear_correct(&linear, given, x, residual, 1e-3, &count, reason);
// Where the residual does not fall any more, rounding of the flows is reached: that is
// the caller's failure to tell.
#pragma once

#include "cholesky.h"
#include "elimination/approximate_cholesky.h"
#include "elimination/conductance_matrix.h"

// AUTO takes the Cholesky factor up to 1500 unknowns, where it is faster, and iteration
// beyond. It names the method; results agree to the caller's tolerance, not to the last
// digit.
enum solver { SOLVER_AUTO, SOLVER_CHOLESKY, SOLVER_ITERATION };

// Made once for a matrix, then asked for corrections as often as its caller's tolerance
// wants: the residual, the limit and the failure are the caller's. It owns all but the
// matrix.
struct linear_solver {
    const struct conductance_matrix *matrix;
    struct cholesky *cholesky; // one of the two, the other NULL
    struct approximate_cholesky *factor;
    double *correction;         // (n)
    double *residual, *work[3]; // (n) of conjugate gradients
};

// The matrix must outlive it. The caller frees with linear_solver_free, also after an
// error: those of cholesky_create; iteration has none.
enum status linear_solver_init(const struct conductance_matrix *matrix,
                               enum solver solver, struct linear_solver *linear,
                               struct reason *reason);
void linear_solver_free(struct linear_solver *linear);

// Corrects X (n_all) by the solution for the balances RESIDUAL (n), which
// conductance_matrix_residual found with GIVEN, and finds RESIDUAL again. Conjugate
// gradients reduce it to REDUCTION of its size, or as far as they can, and add to
// ITERATIONS; after the first call they continue with their last direction.
// STATUS_INTERNAL: no memory.
enum status linear_correct(struct linear_solver *linear, const double *given,
                           struct compensated *x, double *residual, double reduction,
                           int *iterations, struct reason *reason);
