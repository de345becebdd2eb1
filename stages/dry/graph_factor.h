// SPDX-License-Identifier: GPL-3.0-or-later
// The Cholesky factor of a graph's conductance matrix, that follows the graph as it
// changes link by link: what changed goes into the factor by updates and downdates of
// rank one (CHOLMOD), and only when much has changed is it factorised again.
//
// It is meant to precondition: small errors pile up in it from change to change.
#ifndef CRAQUELURE_GRAPH_FACTOR_H
#define CRAQUELURE_GRAPH_FACTOR_H

#include <stdbool.h>

struct graph_factor;

// A graph of at most N_NODE nodes with at most N_LINK links numbered by the caller.
// Freed with graph_factor_free.
struct graph_factor *graph_factor_make(int n_node, int n_link);
void graph_factor_free(struct graph_factor *factor);

// Between graph_factor_begin and graph_factor_finish, the caller names every link of
// the graph once, also those of conductance 0 that may have had another; B = -1 is the
// ground. NODE (N_NODE) are the graph's nodes; others that were in it are left aside,
// and so are links of conductance 0 to them.
void graph_factor_begin(struct graph_factor *factor, int n_node, const int *node);
void graph_factor_link(struct graph_factor *factor, int link, int a, int b,
                       double conductance);

// False if the graph must be named once more, for much has changed; the second time, if
// there is no factor.
bool graph_factor_finish(struct graph_factor *factor);

// Next time the matrix is factorised again, whatever has changed.
void graph_factor_forget(struct graph_factor *factor);

// SOLUTION[k] at NODE[k] (N_NODE, as given last) for the sources RIGHT[k]. False if
// memory ran out.
bool graph_factor_solve(struct graph_factor *factor, const double *right,
                        double *solution);

#endif
