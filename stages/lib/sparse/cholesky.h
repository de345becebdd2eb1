// SPDX-License-Identifier: GPL-3.0-or-later
// Balances of a network of conductances by CHOLMOD: exact to rounding, for up to some
// thousand unknowns (README.md). A factor L D L^T of the balances, made once and used
// for many right sides. Potentials come out in the unit of B over that of the
// conductances.
#pragma once

#include "basics/status.h"
#include "elimination/conductance_matrix.h"

#include <stdbool.h>

struct cholesky;

// Factors MATRIX. STATUS_NOT_CONVERGED: it is not positive definite to rounding;
// STATUS_INTERNAL: out of memory. The caller frees *MADE with cholesky_free, also after
// a failure. MATRIX is only read here, and may be freed before the factor.
enum status cholesky_create(const struct conductance_matrix *matrix,
                            struct cholesky **made, struct reason *reason);
void cholesky_free(struct cholesky *cholesky);

// Solves for B (n) into X (n); false when out of memory. X is taken to be 0 at sites
// where it is given, as in conductance_matrix.h. O(numbers in the factor). For one
// thread at a time.
bool cholesky_solve(struct cholesky *cholesky, const double *b, double *x);
