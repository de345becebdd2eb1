// SPDX-License-Identifier: GPL-3.0-or-later
// The Cholesky factor of a liquid graph, that follows it from change to change.
//
// It is meant to precondition: small errors pile up in it, and arms are followed only
// roughly.
#ifndef CRAQUELURE_GRAPH_FACTOR_H
#define CRAQUELURE_GRAPH_FACTOR_H

#include "cluster_laplacian.h"

// The order in which to eliminate the N nodes of a graph: ROW (n) of each. False if
// memory ran out.
bool graph_factor_order(cholmod_common *common, int n, int n_link,
                        const struct graph_link *link, int *row);

// Not factorised yet, of a graph whose rows come in that order. The caller frees it
// with graph_factor_free.
struct graph_factor *graph_factor_make(cholmod_common *common,
                                       const struct liquid_graph *graph);
void graph_factor_free(struct graph_factor *factor);

// The link at ENTRY has changed.
void graph_factor_note(struct graph_factor *factor, int entry);

// Follows what has changed. False if there is no factor.
bool graph_factor_follow(struct graph_factor *factor, const struct liquid_graph *graph);

// Next time it is made from scratch.
void graph_factor_forget(struct graph_factor *factor);

// X (n) for the right side B (n).
void graph_factor_solve(const struct graph_factor *factor, const double *b, double *x);

// Four arrays (n) for who solves with it.
double **graph_factor_room(struct graph_factor *factor);

#endif
