// SPDX-License-Identifier: GPL-3.0-or-later
// Preconditioned minimal residuals, for symmetric matrices with eigenvalues of both
// signs.
#pragma once

#include "sparse/conjugate_gradients.h"

// Solves A x = RIGHT from x = 0 until the residual, measured by the preconditioner
// (symmetric positive definite), is TOLERANCE of the first, or after MOST iterations.
// Work of the problem is not used. `multiply` must leave alone what it does not write.
// Returns the number of iterations, with what is left of the residual in LEFT.
int minimal_residuals(const struct linear_problem *problem, const double *right,
                      double *x, double tolerance, int most, double *left);
