// SPDX-License-Identifier: GPL-3.0-or-later
// Flow in a cluster that is small, or whose conductances are many decades apart. All
// nodes are eliminated (Kron reduction, elimination/kron.h), which leaves direct links
// between menisci and hands them what stationary menisci extract at the nodes:
//     inflow[a] = sum_b link_ab (potential_b - potential_a) - extracted[a].
// Elimination only adds, multiplies and divides positive numbers, and differences of
// potentials come from the radii (menisci_potential): so flows keep their digits
// however far apart the conductances are.
#include "cluster_flow.h"

#include <math.h>

static double excess_of(const struct liquid_flow *flow, int throat)
{
    return flow->moving[throat] ? 0 : flow->excess[throat];
}

static double drop_between_ends(const void *context, int b, int a)
{
    const struct liquid_flow *flow = context;
    const int to = flow->solver->mover[a], from = flow->solver->mover[b];
    const double drop = menisci_potential(&flow->menisci, from, to);
    if (a < flow->solver->n_mover && b < flow->solver->n_mover) return drop;
    return drop + (excess_of(flow, from) - excess_of(flow, to));
}

static void link_throat(struct liquid_flow *flow, int throat)
{
    struct flow_solver *solver = flow->solver;
    int end[2];
    const int n = liquid_ends(flow, throat, end);
    for (int e = 0; e < n; e++)
        kron_extract(&solver->kron, solver->site[end[e]],
                     extracted_from_end(flow, throat, n));
    if (n == 2)
        kron_link(&solver->kron, solver->site[end[0]], solver->site[end[1]],
                  link_of_ends(flow, throat));
}

static void link_end(struct liquid_flow *flow, int k)
{
    struct flow_solver *solver = flow->solver;
    int end[2];
    const int throat = solver->mover[k], n = liquid_ends(flow, throat, end);
    for (int e = 0; e < n; e++)
        kron_link(&solver->kron, solver->site[end[e]], solver->n_node + k,
                  k < solver->n_mover ? meniscus_arm(flow, throat, n)
                                      : response_arm(flow, throat, n));
}

// Sets the inflow of each end. Returns by how much their sum differs from what is
// extracted in the cluster.
static double find_inflow(struct liquid_flow *flow,
                          const struct cluster_problem *problem)
{
    struct flow_solver *solver = flow->solver;
    double sum = problem->evaporation;
    for (int k = 0; k < solver->n_end; k++) {
        const int throat = solver->mover[k];
        int end[2];
        const int n = liquid_ends(flow, throat, end);
        solver->inflow[throat] = kron_flow(&solver->kron, k, drop_between_ends, flow);
        if (k >= solver->n_mover)
            solver->inflow[throat] += n * extracted_from_end(flow, throat, n);
        sum += solver->inflow[throat] - solver->evaporation[throat];
    }
    return fabs(sum);
}

static void keep_potentials(struct liquid_flow *flow,
                            const struct cluster_problem *problem)
{
    struct flow_solver *solver = flow->solver;
    struct cluster_memory *memory = &solver->cluster[problem->cluster];
    double *level = solver->level;
    for (int k = 0; k < solver->n_end; k++)
        level[solver->n_node + k] =
            end_potential(flow, solver->mover[k], problem->reference);
    kron_potentials(&solver->kron, level);
    for (int k = 0; k < solver->n_node; k++) {
        const int node = solver->node[k];
        struct compensated *potential =
            memory->graph ? &memory->graph->potential[solver->row[node]]
                          : &solver->potential[node];
        *potential = (struct compensated){.value = level[k]};
    }
    memory->reference = problem->reference;
}

// As cluster_flow.h says. Throats with a moving meniscus conduct through their arms
// only.
double solve_cluster_elimination(struct liquid_flow *flow,
                                 struct cluster_problem *problem)
{
    struct flow_solver *solver = flow->solver;
    kron_begin(&solver->kron, solver->n_node, solver->n_end);
    for (int k = 0; k < solver->n_node; k++)
        solver->site[solver->node[k]] = k;
    for (enum throat_list l = 0; l < LISTS; l++)
        for (int t = first_throat(solver, problem, l); t >= 0;
             t = solver->members.next[t])
            if (!flow->moving[t]) link_throat(flow, t);
    for (int k = 0; k < solver->n_end; k++)
        link_end(flow, k);
    for (int k = 0; k < solver->n_node; k++)
        solver->site[solver->node[k]] = -1;
    kron_eliminate(&solver->kron);
    const double residual = find_inflow(flow, problem);
    keep_potentials(flow, problem);
    problem->flow = flow_scale(flow, problem);
    return residual > 0 ? residual / problem->flow : 0;
}
