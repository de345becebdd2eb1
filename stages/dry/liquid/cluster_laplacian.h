// SPDX-License-Identifier: GPL-3.0-or-later
// The balances of a large cluster [K 3.10]: nodes filled with liquid, links of given
// conductance between them, and arms from nodes to menisci at given potentials.
//
// Its Cholesky factor follows the graph as it changes, by updates and downdates of rank
// one (CHOLMOD), and preconditions conjugate gradients; or the factor is a rough one.
// Nodes that leave stay in the factor as rows without links; when many have left, the
// graph should be made again.
//
// In node i:  residual_i = source_i + sum_j conductance_ij (potential_j - potential_i)
//                          + sum over its arms of conductance (level - potential_i).
#pragma once

#include "basics/compensated.h"

#include <cholmod.h>
#include <stdbool.h>

// In one unit, as those of the arms; levels are potentials.
struct graph_link {
    int a, b;
    double conductance;
};

struct graph_arm {
    int a;
    double conductance, level;
};

struct updated_cholesky;
struct rough_factor;

// It owns its arrays but those of the caller.
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
    const struct graph_arm *arm;     // (n_arm) as given last
    double *residual;                // (n)
    struct updated_cholesky *factor; // one of the two, the other NULL
    struct rough_factor *rough;
};

// N nodes and N_LINK links between them, of conductance 0 or more. ROW (n) becomes the
// row of each node, ENTRY (n_link) one of the two places of each link. COMMON must live
// as long. ROUGH: with a rough factor. The caller frees the graph with
// cluster_laplacian_free. NULL if memory ran out.
struct cluster_laplacian *cluster_laplacian_create(cholmod_common *common, int n,
                                                   int n_link,
                                                   const struct graph_link *link,
                                                   bool rough, int *row, int *entry);

// Gives the link at ENTRY another conductance, 0 or more. The factor follows by a
// rank-one update.
void cluster_laplacian_set(struct cluster_laplacian *graph, int entry,
                           double conductance);

// The node of ROW has left: _leave: to another cluster, together with the nodes it is
// linked to; _cut: gas has entered it, and all its links are set to 0.
void cluster_laplacian_leave(struct cluster_laplacian *graph, int row);
void cluster_laplacian_cut(struct cluster_laplacian *graph, int row);

// Replaces all arms by ARM (n_arm), which must live as long.
void cluster_laplacian_set_arms(struct cluster_laplacian *graph, int n_arm,
                                const struct graph_arm *arm);

// Fills graph->residual: the source plus what flows in. Returns the largest absolute
// value; INFINITY if any is not a number.
double cluster_laplacian_residual(struct cluster_laplacian *graph);

// Corrects the potentials for graph->residual (overwritten), until the norm of the
// residual is about TOLERANCE or conjugate gradients stop. False if the matrix is not
// positive definite to rounding.
bool cluster_laplacian_correct(struct cluster_laplacian *graph, double tolerance);

void cluster_laplacian_free(struct cluster_laplacian *graph);
