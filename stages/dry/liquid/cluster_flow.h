// SPDX-License-Identifier: GPL-3.0-or-later
// Potentials and flows in one cluster whose moving menisci are known [K 3.10]. A large
// cluster has a Laplacian with an updated Cholesky factor; one that is small, or whose
// balances do not close, is eliminated.
#pragma once

#include "flow_solver.h"

// Finds the potentials of the nodes, the inflow of the menisci that flow->moving and
// flow->response name, and problem->flow, the scale of the flows.
// STATUS_NOT_CONVERGED if a balance does not close to flow_tolerance.
enum status cluster_flow_solve(struct liquid_flow *flow,
                               struct cluster_problem *problem, struct reason *reason);

// The two solvers. Movers and nodes must be listed in the solver. Each returns the
// largest error of a balance, relative to problem->flow.
double solve_cluster_elimination(struct liquid_flow *flow,
                                 struct cluster_problem *problem);
double solve_cluster_cholesky(struct liquid_flow *flow, struct cluster_problem *problem,
                              struct cluster_laplacian *graph);

// The cluster's graph, made again if too many of its nodes have left; NULL if the
// cluster is too small for one: then its nodes are listed in the solver.
struct cluster_laplacian *find_graph(struct liquid_flow *flow,
                                     const struct cluster_problem *problem);
