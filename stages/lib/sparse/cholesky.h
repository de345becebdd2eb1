// SPDX-License-Identifier: GPL-3.0-or-later
// The balances by CHOLMOD.
#ifndef CRAQUELURE_CHOLESKY_H
#define CRAQUELURE_CHOLESKY_H

#include "basics/status.h"
#include "elimination/conductance_matrix.h"

#include <stdbool.h>

struct cholesky;

// Factorises. STATUS_NOT_CONVERGED: it has no factor to rounding; STATUS_INTERNAL: out
// of memory. The caller frees with cholesky_free, also after a failure.
enum status cholesky_make(const struct matrix *matrix, struct cholesky **made,
                          struct reason *reason);
void cholesky_free(struct cholesky *cholesky);

// Solves for B (n) into X (n); false when out of memory.
bool cholesky_solve(struct cholesky *cholesky, const double *b, double *x);

#endif
