// SPDX-License-Identifier: GPL-3.0-or-later
// A sparse factor near Cholesky's, to precondition conjugate gradients with (R. Kyng,
// S. Sachdeva, Approximate Gaussian elimination for Laplacians, FOCS 2016; as in Gao,
// Kyng, Spielman, Robust and practical solution of Laplacian equations by approximate
// elimination, 2023).
#ifndef CRAQUELURE_APPROXIMATE_CHOLESKY_H
#define CRAQUELURE_APPROXIMATE_CHOLESKY_H

#include "conductance_matrix.h"

struct sampled_factor;

// Eliminates the pores, those with few throats first. A pore with d throats leaves d -
// 1 new ones between its neighbours in place of d (d - 1) / 2: drawn so that their mean
// is what elimination would leave. The draws are the same every time. O(n log n). The
// caller frees with sampled_factor_free.
struct sampled_factor *sampled_factor_make(const struct matrix *matrix);
void sampled_factor_free(struct sampled_factor *factor);

// X (n) = the inverse of the factor times B (n).
void sampled_factor_apply(struct sampled_factor *factor, const double *b, double *x);

#endif
