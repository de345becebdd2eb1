// SPDX-License-Identifier: GPL-3.0-or-later
// A preconditioner of the balances of a gas that grows: an approximate factor in two
// parts. Inner rows have no links to what is not yet in the gas, so their balances stay
// as they are, and are eliminated once. The small network that this leaves between the
// other rows, the front, is eliminated again whenever the gas has grown.
#pragma once

#include "elimination/approximate_cholesky.h"

struct gas_preconditioner;

// Eliminates the first N_INNER rows of MATRIX. Columns from MATRIX->n on are not in the
// gas. Its rows may become N_MOST. The caller frees it with gas_preconditioner_free.
struct gas_preconditioner *
gas_preconditioner_create(const struct conductance_matrix *matrix, int n_inner,
                          int n_most);
void gas_preconditioner_free(struct gas_preconditioner *gas);

// Eliminates the front. MATRIX may have new rows at its end, and links to them in the
// front. Returns the share of all rows that are in the front.
double gas_preconditioner_follow(struct gas_preconditioner *gas,
                                 const struct conductance_matrix *matrix);

// Z (n) = M^-1 B (n), symmetric and positive definite. B as approximate_cholesky_apply
// wants it.
void gas_preconditioner_apply(struct gas_preconditioner *gas, const double *b,
                              double *z);
