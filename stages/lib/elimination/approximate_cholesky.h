// SPDX-License-Identifier: GPL-3.0-or-later
// A sparse factor near Cholesky's, to precondition conjugate gradients with (R. Kyng,
// S. Sachdeva, Approximate Gaussian elimination for Laplacians, FOCS 2016; as in Gao,
// Kyng, Spielman, Robust and practical solution of Laplacian equations by approximate
// elimination, 2023).
#pragma once

#include "conductance_matrix.h"

struct approximate_cholesky;

// Eliminates the sites, those of low degree first. A site with d links leaves d - 1 new
// ones between its neighbours in place of d (d - 1) / 2, drawn so that their mean is
// what elimination would leave. The draws are the same every time. O(n log n). The
// caller frees the result with approximate_cholesky_free.
struct approximate_cholesky *
approximate_cholesky_create(const struct conductance_matrix *matrix);
void approximate_cholesky_free(struct approximate_cholesky *factor);

// The same for all but N_KEPT sites, to which columns n to n + n_kept - 1 of MATRIX
// lead: they stay, joined by LINK (*N_LINK), which the caller frees. A site of n +
// n_kept is ground. Links between kept sites that are there already are not among them.
struct approximate_cholesky *
approximate_cholesky_create_partly(const struct conductance_matrix *matrix, int n_kept,
                                   int *n_link, struct link **link);

// Of L D L' X = B (n + n_kept): KEPT (n_kept) becomes the right side for the kept sites
// alone, whose X then gives that of the others.
void approximate_cholesky_reduce(struct approximate_cholesky *factor, const double *b,
                                 double *kept);
void approximate_cholesky_extend(struct approximate_cholesky *factor,
                                 const double *kept, double *x);

// X (n) = (L D L')^-1 B (n), in single precision; no site is kept.
void approximate_cholesky_apply(struct approximate_cholesky *factor, const double *b,
                                double *x);
