// SPDX-License-Identifier: GPL-3.0-or-later
#include "cluster_flow.h"

#include <math.h>

static void list_movers(struct liquid_flow *flow, const struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    solver->n_mover = 0;
    for (int t = first_throat(solver, piece, LIST_MENISCI); t >= 0;
         t = solver->lists.next[t])
        if (flow->moving[t]) solver->mover[solver->n_mover++] = t;
}

double flow_scale(const struct flow_solver *solver, const struct piece *piece)
{
    double scale = piece->evaporation;
    for (int k = 0; k < solver->n_mover; k++)
        scale = fmax(scale, fabs(solver->inflow[solver->mover[k]]));
    return scale;
}

enum status cluster_flow_solve(struct liquid_flow *flow, struct piece *piece,
                               struct reason *reason)
{
    struct flow_solver *solver = flow->solver;
    double error = INFINITY;
    list_movers(flow, piece);
    struct liquid_graph *graph = find_graph(flow, piece);
    if (graph) error = solve_by_graph(flow, piece, graph);
    if (graph && !(error < FLOW_TOLERANCE)) {
        free_graph(solver, &solver->cluster[piece->cluster]);
        list_nodes(flow, piece);
    }
    if (!(error < FLOW_TOLERANCE)) error = solve_by_elimination(flow, piece);
    if (!(error < FLOW_TOLERANCE))
        return refuse(reason, STATUS_NOT_CONVERGED,
                      "the liquid's balance closes to %.3g of its largest flow only, "
                      "needed is %g (%d unknowns)",
                      error, FLOW_TOLERANCE, solver->n_node);
    flow->residual = fmax(flow->residual, error);
    return STATUS_OK;
}
