// SPDX-License-Identifier: GPL-3.0-or-later
// The balances of a large cluster: nodes that liquid fills, links of conductances
// between them, and arms from them to menisci at given potentials.
//
// Its Cholesky factor follows the graph as it changes, by updates and downdates of rank
// one (CHOLMOD), and preconditions conjugate gradients. Nodes that leave stay in the
// factor as rows without links; when many have, the graph is worth making anew.
#ifndef CRAQUELURE_LIQUID_GRAPH_H
#define CRAQUELURE_LIQUID_GRAPH_H

#include "basics/compensated.h"

#include <cholmod.h>
#include <stdbool.h>

struct graph_link {
    int a, b;
    double conductance;
};

struct graph_arm {
    int a;
    double conductance, level;
};

struct graph_factor;

struct liquid_graph {
    int n, n_left;       // rows, and those of them whose nodes have left
    double *present;     // (n) 1, or 0 once the node has left
    int *offset;         // (n+1)
    int *column;         // (offset[n]) every link twice, in the rows of both its ends
    int *mirror;         // (offset[n]) where the other is
    double *conductance; // (offset[n])
    double *ground;      // (n) conductance of all arms

    // Of the caller, (n) each.
    struct compensated *potential;
    double *source;

    int n_arm;
    const struct graph_arm *arm; // (n_arm) as given last
    double *lack;                // (n)
    struct graph_factor *factor;
};

// N nodes and N_LINK links between them, of conductance 0 or more. ROW (n) becomes the
// row of each node, ENTRY (n_link) one of the two places of each link. COMMON must live
// as long. The caller frees the graph with liquid_graph_free. NULL if memory ran out.
struct liquid_graph *liquid_graph_make(cholmod_common *common, int n, int n_link,
                                       const struct graph_link *link, int *row,
                                       int *entry);

// Gives the link at ENTRY another conductance.
void liquid_graph_set(struct liquid_graph *graph, int entry, double conductance);

// The node of ROW has left: to another cluster, with those it is still linked to; or
// for gas, and is cut off from all others.
void liquid_graph_leave(struct liquid_graph *graph, int row);
void liquid_graph_cut(struct liquid_graph *graph, int row);

// Replaces all arms by ARM (n_arm), which must live as long.
void liquid_graph_set_arms(struct liquid_graph *graph, int n_arm,
                           const struct graph_arm *arm);

// What the balances lack: the source, less what flows off. Returns the largest.
double liquid_graph_lack(struct liquid_graph *graph);

// Adds to the potentials what the balances lack, until the norm of the lack is about
// AIM, or nearer to it. False if the matrix is not positive definite to rounding.
bool liquid_graph_correct(struct liquid_graph *graph, double aim);

void liquid_graph_free(struct liquid_graph *graph);

#endif
