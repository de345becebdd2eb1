// SPDX-License-Identifier: GPL-3.0-or-later
// A sparse factor near Cholesky's, to precondition conjugate gradients with (R. Kyng,
// S. Sachdeva, Approximate Gaussian elimination for Laplacians, FOCS 2016; as in Gao,
// Kyng, Spielman, Robust and practical solution of Laplacian equations by approximate
// elimination, 2023).
#ifndef CRAQUELURE_APPROXIMATE_CHOLESKY_H
#define CRAQUELURE_APPROXIMATE_CHOLESKY_H

#include "conductance_matrix.h"

struct approximate_cholesky;

// Eliminates the sites, those of low degree first. A site with d links leaves d - 1 new
// ones between its neighbours in place of d (d - 1) / 2, drawn so that their mean is
// what elimination would leave. The draws are the same every time. O(n log n). The
// caller frees the result with approximate_cholesky_free.
struct approximate_cholesky *
approximate_cholesky_create(const struct conductance_matrix *matrix);
void approximate_cholesky_free(struct approximate_cholesky *factor);

// X (n) = (L D L')^-1 B (n), in single precision.
void approximate_cholesky_apply(struct approximate_cholesky *factor, const double *b,
                                double *x);

#endif
