// SPDX-License-Identifier: GPL-3.0-or-later
// Flow in a large cluster, starting from its potentials at the previous step:
//     sum_j conductance_ij (potential_j - potential_i)
//         + sum over arms of conductance (level - potential_i) + source_i = 0
// in each node i, where arms lead to menisci of known potential and source is minus
// what stationary menisci take. Potentials are relative to the throat that gas enters
// most easily: when that changes, all are shifted. Iterative refinement: residuals
// come from potentials in two parts, each correction from the updated factor, at most
// REFINEMENTS times; from a rough factor where the cluster is very large and its flow
// is not found at each event.
#include "cluster_flow.h"

#include "basics/memory.h"

#include <stdlib.h>

// A cluster of at least GRAPH_NODES nodes has a graph, which is made again when more
// than MAX_LEFT_SHARE of its nodes have left; one of ROUGH_NODES whose flow is kept has
// a rough factor.
enum { GRAPH_NODES = 150, ROUGH_NODES = 10000, REFINEMENTS = 8 };
static const double MAX_LEFT_SHARE = 0.06;

static int list_links(struct liquid_flow *flow, const struct cluster_problem *problem)
{
    struct flow_solver *solver = flow->solver;
    int n_link = 0;
    for (enum throat_list l = 0; l < LISTS; l++)
        for (int t = first_throat(solver, problem, l); t >= 0;
             t = solver->members.next[t]) {
            int end[2];
            solver->entry[t] = -1;
            if (liquid_ends(flow, t, end) != 2) continue;
            solver->entry[t] = n_link;
            solver->link[n_link++] = (struct graph_link){
                solver->site[end[0]], solver->site[end[1]], link_of_ends(flow, t)};
        }
    return n_link;
}

// Makes the graph of the nodes that are listed, with their potentials of before.
static bool make_graph(struct liquid_flow *flow, const struct cluster_problem *problem)
{
    struct flow_solver *solver = flow->solver;
    struct cluster_memory *memory = &solver->cluster[problem->cluster];
    const int n = solver->n_node;
    for (int k = 0; k < n; k++)
        solver->site[solver->node[k]] = k;
    const int n_link = list_links(flow, problem);
    for (int k = 0; k < n; k++)
        solver->site[solver->node[k]] = -1;
    int *row = NEW_ARRAY(int, n), *entry = NEW_ARRAY(int, n_link);
    const bool rough = flow->step > 0 && n >= ROUGH_NODES;
    memory->graph = cluster_laplacian_create(&solver->common, n, n_link, solver->link,
                                             rough, row, entry);
    if (memory->graph) {
        memory->node = NEW_ARRAY(int, n);
        for (int k = 0; k < n; k++) {
            memory->node[row[k]] = solver->node[k];
            solver->row[solver->node[k]] = row[k];
            if (memory->reference >= 0)
                memory->graph->potential[row[k]] = solver->potential[solver->node[k]];
        }
        for (enum throat_list l = 0; l < LISTS; l++)
            for (int t = first_throat(solver, problem, l); t >= 0;
                 t = solver->members.next[t])
                if (solver->entry[t] >= 0) solver->entry[t] = entry[solver->entry[t]];
    }
    free(row);
    free(entry);
    return memory->graph;
}

struct cluster_laplacian *find_graph(struct liquid_flow *flow,
                                     const struct cluster_problem *problem)
{
    struct flow_solver *solver = flow->solver;
    struct cluster_memory *memory = &solver->cluster[problem->cluster];
    const struct cluster_laplacian *old = memory->graph;
    if (old && old->n_left <= MAX_LEFT_SHARE * old->n) return memory->graph;
    free_graph(solver, memory);
    list_nodes(flow, problem);
    if (solver->n_node >= GRAPH_NODES) make_graph(flow, problem);
    return memory->graph;
}

// Shifts all potentials to the new reference throat.
static void change_reference(struct liquid_flow *flow,
                             const struct cluster_problem *problem)
{
    struct cluster_memory *memory = &flow->solver->cluster[problem->cluster];
    if (memory->reference >= 0 && memory->reference != problem->reference) {
        const double rise =
            menisci_potential(&flow->menisci, memory->reference, problem->reference);
        for (int k = 0; k < memory->graph->n; k++)
            compensated_add(&memory->graph->potential[k], rise);
    }
    memory->reference = problem->reference;
}

// Sources of stationary menisci, and arms to those that move or respond.
static void set_boundary_conditions(struct liquid_flow *flow,
                                    const struct cluster_problem *problem,
                                    struct cluster_laplacian *graph)
{
    struct flow_solver *solver = flow->solver;
    int n_arm = 0;
    for (int k = 0; k < graph->n; k++)
        graph->source[k] = 0;
    for (int t = first_throat(solver, problem, LIST_MENISCI); t >= 0;
         t = solver->members.next[t]) {
        int end[2];
        const int n = liquid_ends(flow, t, end);
        if (solver->entry[t] >= 0 && n == 2)
            cluster_laplacian_set(graph, solver->entry[t], link_of_ends(flow, t));
        for (int e = 0; e < n; e++) {
            const int row = solver->row[end[e]];
            if (flow->moving[t])
                solver->arm[n_arm++] = (struct graph_arm){
                    row, meniscus_arm(flow, t, n),
                    menisci_potential(&flow->menisci, t, problem->reference)};
            else
                graph->source[row] -= extracted_from_end(flow, t, n);
        }
    }
    for (int k = solver->n_mover; k < solver->n_end; k++) {
        int end[2];
        const int t = solver->mover[k], n = liquid_ends(flow, t, end);
        for (int e = 0; e < n; e++)
            solver->arm[n_arm++] =
                (struct graph_arm){solver->row[end[e]], response_arm(flow, t, n),
                                   end_potential(flow, t, problem->reference)};
    }
    cluster_laplacian_set_arms(graph, n_arm, solver->arm);
}

// Arms come in the order of the movers and then of the menisci that respond.
static void collect_inflow(struct liquid_flow *flow,
                           const struct cluster_laplacian *graph)
{
    struct flow_solver *solver = flow->solver;
    const struct graph_arm *arm = graph->arm;
    for (int k = 0; k < solver->n_end; k++) {
        int end[2];
        const int throat = solver->mover[k], n = liquid_ends(flow, throat, end);
        double sum = k < solver->n_mover ? 0 : n * extracted_from_end(flow, throat, n);
        for (int e = 0; e < n; e++, arm++) {
            const struct compensated level = {.value = arm->level};
            sum += arm->conductance *
                   compensated_difference(graph->potential[arm->a], level);
        }
        solver->inflow[throat] = sum;
    }
}

// Largest error of a balance, relative to the largest flow; 0 where nothing flows, as
// between menisci of equal potential.
static double graph_error(struct liquid_flow *flow, struct cluster_problem *problem,
                          struct cluster_laplacian *graph)
{
    const double residual = cluster_laplacian_residual(graph);
    collect_inflow(flow, graph);
    problem->flow = flow_scale(flow, problem);
    return residual > 0 ? residual / problem->flow : 0;
}

double solve_cluster_cholesky(struct liquid_flow *flow, struct cluster_problem *problem,
                              struct cluster_laplacian *graph)
{
    change_reference(flow, problem);
    set_boundary_conditions(flow, problem, graph);
    double error = graph_error(flow, problem, graph);
    const double target = problem->target;
    for (int k = 0; k < REFINEMENTS && !(error <= target); k++) {
        const bool good = cluster_laplacian_correct(graph, target * problem->flow);
        error = graph_error(flow, problem, graph);
        if (!good) break;
    }
    return error;
}
