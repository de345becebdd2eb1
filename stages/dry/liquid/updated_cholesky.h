// SPDX-License-Identifier: GPL-3.0-or-later
// The Cholesky factor of a liquid graph, that follows it from change to change.
//
// It is meant to precondition: small errors pile up in it, and arms are followed only
// roughly.
#ifndef CRAQUELURE_UPDATED_CHOLESKY_H
#define CRAQUELURE_UPDATED_CHOLESKY_H

#include "cluster_laplacian.h"

// The order in which to eliminate the N nodes of a graph: ROW (n) of each. False if
// memory ran out.
bool updated_cholesky_order(cholmod_common *common, int n, int n_link,
                            const struct graph_link *link, int *row);

// Not factorised yet, of a graph whose rows come in that order. The caller frees it
// with updated_cholesky_free.
struct updated_cholesky *updated_cholesky_make(cholmod_common *common,
                                               const struct cluster_laplacian *graph);
void updated_cholesky_free(struct updated_cholesky *factor);

// The link at ENTRY has changed.
void updated_cholesky_note(struct updated_cholesky *factor, int entry);

// Follows what has changed. False if there is no factor.
bool updated_cholesky_follow(struct updated_cholesky *factor,
                             const struct cluster_laplacian *graph);

// Next time it is made from scratch.
void updated_cholesky_forget(struct updated_cholesky *factor);

// X (n) for the right side B (n).
void updated_cholesky_solve(const struct updated_cholesky *factor, const double *b,
                            double *x);

// Four arrays (n) for who solves with it.
double **updated_cholesky_scratch(struct updated_cholesky *factor);

#endif
