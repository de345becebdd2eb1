// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the solver of one cluster and checks its result: the updated factor first,
// and if its balances do not close to flow_tolerance, as with conductances many
// decades apart, elimination without cancellation.
//
// list_ends puts the menisci that move first in `mover` (n_mover), then those that do
// not move but whose pressure responds to their flow (to n_end). `error` is the largest
// imbalance of a node over the largest flow; the factor that failed is freed, so that
// the next step does not update it. Neither within flow_tolerance: status 3.
#include "cluster_flow.h"

#include <math.h>

static void list_ends(struct liquid_flow *flow, const struct cluster_problem *problem)
{
    struct flow_solver *solver = flow->solver;
    solver->n_mover = 0;
    for (int t = first_throat(solver, problem, LIST_MENISCI); t >= 0;
         t = solver->members.next[t])
        if (flow->moving[t]) solver->mover[solver->n_mover++] = t;
    solver->n_end = solver->n_mover;
    for (int t = first_throat(solver, problem, LIST_MENISCI); flow->response && t >= 0;
         t = solver->members.next[t])
        if (!flow->moving[t] && flow->response[t] > 0)
            solver->mover[solver->n_end++] = t;
}

enum status cluster_flow_solve(struct liquid_flow *flow,
                               struct cluster_problem *problem, struct reason *reason)
{
    struct flow_solver *solver = flow->solver;
    const double tolerance = fmax(flow_tolerance(flow), 2 * problem->target);
    double error = INFINITY;
    list_ends(flow, problem);
    struct cluster_laplacian *graph = find_graph(flow, problem);
    if (graph) error = solve_cluster_cholesky(flow, problem, graph);
    if (graph && !(error < tolerance)) {
        free_graph(solver, &solver->cluster[problem->cluster]);
        list_nodes(flow, problem);
    }
    if (!(error < tolerance)) error = solve_cluster_elimination(flow, problem);
    if (!(error < tolerance))
        return refuse(reason, STATUS_NOT_CONVERGED,
                      "the liquid's balance closes to %.3g of its largest flow only, "
                      "needed is %g (%d unknowns)",
                      error, tolerance, solver->n_node);
    problem->error = error;
    return STATUS_OK;
}
