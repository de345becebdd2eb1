// SPDX-License-Identifier: GPL-3.0-or-later
// What is added to the pressures so that balances close: by Cholesky's factor, or by
// conjugate gradients with a sampled factor.
#ifndef CRAQUELURE_FLOW_LINEAR_SOLVER_H
#define CRAQUELURE_FLOW_LINEAR_SOLVER_H

#include "cholesky.h"
#include "matrix.h"
#include "sampled_factor.h"

enum solver { SOLVER_AUTO, SOLVER_CHOLESKY, SOLVER_ITERATION };

struct linear_solver {
    const struct matrix *matrix;
    struct cholesky *cholesky; // one of the two, the other NULL
    struct sampled_factor *factor;
    double *residual, *work[3]; // (n) of conjugate gradients
};

// The matrix must outlive it. The caller frees with linear_solver_free, also after an
// error.
enum status linear_solver_make(const struct matrix *matrix, enum solver solver,
                               struct linear_solver *linear, struct reason *reason);
void linear_solver_free(struct linear_solver *linear);

// X (n) for the lacks B (n), in the units of the matrix. Conjugate gradients take the
// residual down to REDUCTION of that of zero, or as far as they come, and add to
// ITERATIONS; after the first call B is taken to be what the sum of the X still lacks.
// STATUS_INTERNAL: no memory.
enum status linear_solve(struct linear_solver *linear, const double *b, double *x,
                         double reduction, int *iterations, struct reason *reason);

#endif
