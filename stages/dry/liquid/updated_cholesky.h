// SPDX-License-Identifier: GPL-3.0-or-later
// The Cholesky factor of a cluster's matrix, kept up to date by rank-one changes (Davis
// and Hager 1999, CHOLMOD).
//
// It is meant as a preconditioner: small errors accumulate in it, and arms are followed
// only roughly. A link that changes is one column of an update; where many change at
// once it is factorised again, which is cheaper then.
#pragma once

#include "cluster_laplacian.h"

// The order in which to eliminate the N nodes of a graph, to keep the factor sparse:
// ROW (n) becomes the row of each node. False if memory ran out.
bool updated_cholesky_order(cholmod_common *common, int n, int n_link,
                            const struct graph_link *link, int *row);

// A factor for GRAPH, whose rows are in that order; it is computed at the first
// updated_cholesky_follow. COMMON must live as long. The caller frees it with
// updated_cholesky_free.
struct updated_cholesky *updated_cholesky_create(cholmod_common *common,
                                                 const struct cluster_laplacian *graph);
void updated_cholesky_free(struct updated_cholesky *factor);

// Notes that the link at ENTRY has changed; the next _follow applies it. O(1).
void updated_cholesky_note(struct updated_cholesky *factor, int entry);

// Applies all changes of GRAPH since the last call, or factorises. False if that
// failed: then there is no factor.
bool updated_cholesky_follow(struct updated_cholesky *factor,
                             const struct cluster_laplacian *graph);

// The next _follow factorises from scratch.
void updated_cholesky_forget(struct updated_cholesky *factor);

// Solves for X (n) with the right-hand side B (n). There must be a factor.
void updated_cholesky_solve(const struct updated_cholesky *factor, const double *b,
                            double *x);

// Four arrays (n) that a solver may use between calls.
double **updated_cholesky_scratch(struct updated_cholesky *factor);
