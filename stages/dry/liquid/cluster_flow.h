// SPDX-License-Identifier: GPL-3.0-or-later
// Potentials and flows in one cluster, for menisci of which it is known which move: by
// a graph whose factor is kept if the cluster is large, by elimination if it is small
// or its balances do not close.
#ifndef CRAQUELURE_CLUSTER_FLOW_H
#define CRAQUELURE_CLUSTER_FLOW_H

#include "flow_solver.h"

// Largest error of a node's balance, relative to the largest flow in its cluster.
#define FLOW_TOLERANCE 1e-11

// Potentials, flows to the menisci that FLOW says move, and their scale.
enum status cluster_flow_solve(struct liquid_flow *flow,
                               struct cluster_problem *problem, struct reason *reason);

// Either way: movers and nodes are listed; returns the error of the balances, of the
// largest flow.
double solve_cluster_elimination(struct liquid_flow *flow,
                                 struct cluster_problem *problem);
double solve_cluster_cholesky(struct liquid_flow *flow, struct cluster_problem *problem,
                              struct cluster_laplacian *graph);

// The cluster's graph; NULL if it is too small for one: then its nodes are listed.
struct cluster_laplacian *find_graph(struct liquid_flow *flow,
                                     const struct cluster_problem *problem);

#endif
