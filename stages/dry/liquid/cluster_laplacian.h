// SPDX-License-Identifier: GPL-3.0-or-later
// The balances of a large cluster: nodes that liquid fills, links of conductances
// between them, and arms from them to menisci at given potentials.
//
// Its Cholesky factor follows the graph as it changes, by updates and downdates of rank
// one (CHOLMOD), and preconditions conjugate gradients. Nodes that leave stay in the
// factor as rows without links; when many have, the graph is worth making anew.
#ifndef CRAQUELURE_CLUSTER_LAPLACIAN_H
#define CRAQUELURE_CLUSTER_LAPLACIAN_H

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

struct updated_cholesky;

struct cluster_laplacian {
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
    double *residual;            // (n)
    struct updated_cholesky *factor;
};

// N nodes and N_LINK links between them, of conductance 0 or more. ROW (n) becomes the
// row of each node, ENTRY (n_link) one of the two places of each link. COMMON must live
// as long. The caller frees the graph with cluster_laplacian_free. NULL if memory ran
// out.
struct cluster_laplacian *cluster_laplacian_make(cholmod_common *common, int n,
                                                 int n_link,
                                                 const struct graph_link *link,
                                                 int *row, int *entry);

// Gives the link at ENTRY another conductance.
void cluster_laplacian_set(struct cluster_laplacian *graph, int entry,
                           double conductance);

// The node of ROW has left: to another cluster, with those it is still linked to; or
// for gas, and is cut off from all others.
void cluster_laplacian_leave(struct cluster_laplacian *graph, int row);
void cluster_laplacian_cut(struct cluster_laplacian *graph, int row);

// Replaces all arms by ARM (n_arm), which must live as long.
void cluster_laplacian_set_arms(struct cluster_laplacian *graph, int n_arm,
                                const struct graph_arm *arm);

// What the balances lack: the source, less what flows off. Returns the largest.
double cluster_laplacian_residual(struct cluster_laplacian *graph);

// Adds to the potentials what the balances lack, until the norm of the lack is about
// TOLERANCE, or nearer to it. False if the matrix is not positive definite to rounding.
bool cluster_laplacian_correct(struct cluster_laplacian *graph, double tolerance);

void cluster_laplacian_free(struct cluster_laplacian *graph);

#endif
