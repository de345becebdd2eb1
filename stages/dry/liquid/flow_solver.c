// SPDX-License-Identifier: GPL-3.0-or-later
// What a cluster's flow needs from step to step, and the conductances at menisci. In a
// throat with n liquid ends (1, or 2 where it empties from its middle), filled to the
// saturation S, the meniscus is linked to each end by
//     arm = n conductance / S,
// since only S L of its length is filled [K 3.10]. If vapour follows the pressure, so
// that evaporation rises by response with the potential behind the meniscus, arm and
// response / n are in series:
//     arm (response / n) / (arm + response / n),
// and the given evaporation is reduced alike (through_arm). So is what a throat with
// two liquid ends conducts between them: the meniscus stands between its two arms. Then
// a response that is not needed, as all has been found, changes nothing. Graph,
// potentials and lists of a cluster are kept in cluster_memory and follow it when it
// splits.
#include "flow_solver.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// Response times potential is a flow that cancels: this part of it enters the scale of
// flows, so that its rounding is below flow_target of the scale.
static const double ROUNDING_SHARE = 1e-2;

// --- one throat, one cluster ---------------------------------------------------------

bool throat_is_full(const struct occupancy *occupancy, int throat)
{
    return !(occupancy_saturation(occupancy, throat) < 1);
}

// Whether liquid goes from throat to throat at NODE.
static bool passes_on(const struct occupancy *occupancy, int node)
{
    return occupancy->clusters.joins[node] && occupancy->liquid_beside[node] > 1;
}

int liquid_ends(const struct liquid_flow *flow, int throat, int end[2])
{
    int n = 0;
    for (int k = 0; k < 2; k++) {
        const int node = flow->network->throat_nodes[throat][k];
        if (passes_on(flow->solver->occupancy, node)) end[n++] = node;
    }
    return n;
}

double meniscus_arm(const struct liquid_flow *flow, int throat, int n)
{
    return n * flow->conductance[throat] /
           occupancy_saturation(flow->solver->occupancy, throat);
}

// arm / (arm + response / n): half of the response is at either end of a throat with
// two.
static double through_arm(const struct liquid_flow *flow, int throat, int n)
{
    if (!flow->response) return 1;
    const double arm = meniscus_arm(flow, throat, n);
    return arm / (arm + flow->response[throat] / n);
}

double response_arm(const struct liquid_flow *flow, int throat, int n)
{
    return flow->response[throat] / n * through_arm(flow, throat, n);
}

double extracted_from_end(const struct liquid_flow *flow, int throat, int n)
{
    return flow->solver->evaporation[throat] / n * through_arm(flow, throat, n);
}

double link_of_ends(const struct liquid_flow *flow, int throat)
{
    if (flow->moving[throat]) return 0;
    return flow->conductance[throat] * through_arm(flow, throat, 2);
}

double end_potential(const struct liquid_flow *flow, int throat, int reference)
{
    const double moves = menisci_potential(&flow->menisci, throat, reference);
    return flow->moving[throat] ? moves : moves + flow->excess[throat];
}

double node_potential(const struct flow_solver *solver, int cluster, int node)
{
    const struct cluster_laplacian *graph = solver->cluster[cluster].graph;
    return compensated_value(graph ? graph->potential[solver->row[node]]
                                   : solver->potential[node]);
}

double potential_of_ends(const struct liquid_flow *flow, int cluster, int throat,
                         int *n)
{
    int end[2];
    double mean = 0;
    *n = liquid_ends(flow, throat, end);
    for (int k = 0; k < *n; k++)
        mean += node_potential(flow->solver, cluster, end[k]) / *n;
    return mean;
}

int first_throat(const struct flow_solver *solver,
                 const struct cluster_problem *problem, enum throat_list list)
{
    return cluster_members_first(&solver->members, problem->cluster, list);
}

static void add_node(struct flow_solver *solver, int node)
{
    if (solver->site[node] >= 0) return;
    solver->site[node] = solver->n_node;
    solver->node[solver->n_node++] = node;
}

void list_nodes(struct liquid_flow *flow, const struct cluster_problem *problem)
{
    struct flow_solver *solver = flow->solver;
    solver->n_node = 0;
    for (enum throat_list l = 0; l < LISTS; l++)
        for (int t = first_throat(solver, problem, l); t >= 0;
             t = solver->members.next[t]) {
            int end[2];
            const int n = liquid_ends(flow, t, end);
            for (int e = 0; e < n; e++)
                add_node(solver, end[e]);
        }
    for (int k = 0; k < solver->n_node; k++)
        solver->site[solver->node[k]] = -1;
}

// --- from event to event -------------------------------------------------------------

void free_graph(struct flow_solver *solver, struct cluster_memory *memory)
{
    struct cluster_laplacian *graph = memory->graph;
    for (int k = 0; graph && k < graph->n; k++) {
        if (graph->present[k] == 0) continue;
        solver->potential[memory->node[k]] = graph->potential[k];
        solver->row[memory->node[k]] = -1;
    }
    cluster_laplacian_free(graph);
    free(memory->node);
    memory->graph = NULL;
    memory->node = NULL;
}

static void reserve(struct flow_solver *solver, int n_id)
{
    while (solver->capacity < n_id) {
        const int before = solver->capacity;
        GROW_ARRAY(solver->cluster, solver->capacity, solver->capacity);
        for (int c = before; c < solver->capacity; c++)
            solver->cluster[c] = (struct cluster_memory){.reference = -1};
    }
}

// Gas has entered NODE: it leaves the cluster's graph.
static void cut_node(struct flow_solver *solver, struct cluster_memory *memory,
                     int node)
{
    if (solver->row[node] < 0) return;
    cluster_laplacian_cut(memory->graph, solver->row[node]);
    solver->row[node] = -1;
}

// THROAT belongs to a new cluster: its nodes keep their potentials but leave the graph.
static void part_with(struct flow_solver *solver, const struct network *network,
                      struct cluster_memory *memory, int throat)
{
    solver->entry[throat] = -1;
    for (int end = 0; end < 2; end++) {
        const int node = network->throat_nodes[throat][end], row = solver->row[node];
        if (row < 0) continue;
        solver->potential[node] = memory->graph->potential[row];
        cluster_laplacian_leave(memory->graph, row);
        solver->row[node] = -1;
    }
}

void flow_solver_follow(struct flow_solver *solver, const struct occupancy *occupancy,
                        int throat)
{
    const struct clusters *clusters = &occupancy->clusters;
    const struct incidence *incidence = &occupancy->incidence;
    reserve(solver, clusters->n_id);
    const int old = solver->members.cluster[throat];
    struct cluster_memory *memory = &solver->cluster[old];
    memory->changed += occupancy->volume[throat];
    const int32_t *node = occupancy->network->throat_nodes[throat];
    for (int end = 0; end < 2; end++)
        cut_node(solver, memory, node[end]);
    cluster_members_follow(&solver->members, clusters, throat);
    for (int k = 0; k < clusters->n_moved; k++) {
        const int moved = clusters->moved[k];
        part_with(solver, occupancy->network, memory, moved);
        cluster_members_follow(&solver->members, clusters, moved);
        solver->cluster[clusters->of_throat[moved]] =
            (struct cluster_memory){.reference = memory->reference,
                                    .resistance = memory->resistance,
                                    .size = memory->size};
    }
    for (int end = 0; end < 2; end++)
        for (int k = incidence->offset[node[end]]; k < incidence->offset[node[end] + 1];
             k++)
            cluster_members_follow(&solver->members, clusters, incidence->throat[k]);
    if (clusters->size[old] > 0) return;
    free_graph(solver, memory);
    *memory = (struct cluster_memory){.reference = -1};
}

void flow_solver_forget(struct flow_solver *solver, const struct occupancy *occupancy)
{
    for (int c = 0; c < solver->capacity; c++) {
        free_graph(solver, &solver->cluster[c]);
        solver->cluster[c] = (struct cluster_memory){.reference = -1};
    }
    reserve(solver, occupancy->clusters.n_id);
    cluster_members_free(&solver->members);
    solver->members =
        cluster_members_init(&occupancy->clusters, occupancy->network->n_throat);
}

struct flow_solver *flow_solver_create(const struct occupancy *occupancy)
{
    const int n_node = occupancy->network->n_node,
              n_throat = occupancy->network->n_throat;
    struct flow_solver *solver = NEW_ARRAY(struct flow_solver, 1);
    *solver = (struct flow_solver){
        .members = cluster_members_init(&occupancy->clusters, n_throat),
        .row = NEW_ARRAY(int, n_node),
        .entry = NEW_ARRAY(int, n_throat),
        .potential = NEW_ARRAY(struct compensated, n_node),
        .inflow = NEW_ARRAY(double, n_throat),
        .mover = NEW_ARRAY(int, n_throat),
        .arm = NEW_ARRAY(struct graph_arm, 2 * (size_t)n_throat),
        .node = NEW_ARRAY(int, n_node),
        .site = NEW_ARRAY(int, n_node),
        .level = NEW_ARRAY(double, (size_t)n_node + (size_t)n_throat),
        .link = NEW_ARRAY(struct graph_link, n_throat)};
    for (int i = 0; i < n_node; i++)
        solver->row[i] = solver->site[i] = -1;
    for (int t = 0; t < n_throat; t++)
        solver->entry[t] = -1;
    reserve(solver, occupancy->clusters.n_id);
    cholmod_serial_start(&solver->common);
    return solver;
}

void flow_solver_free(struct flow_solver *solver)
{
    if (!solver) return;
    for (int c = 0; c < solver->capacity; c++)
        free_graph(solver, &solver->cluster[c]);
    cholmod_finish(&solver->common);
    cluster_members_free(&solver->members);
    kron_free(&solver->kron);
    free(solver->cluster);
    free(solver->row);
    free(solver->entry);
    free(solver->potential);
    free(solver->inflow);
    free(solver->mover);
    free(solver->arm);
    free(solver->node);
    free(solver->site);
    free(solver->level);
    free(solver->link);
    free(solver);
}

// --- scale ---------------------------------------------------------------------------

double flow_scale(const struct liquid_flow *flow, const struct cluster_problem *problem)
{
    const struct flow_solver *solver = flow->solver;
    double scale = problem->turnover;
    for (int k = 0; k < solver->n_mover; k++)
        scale = fmax(scale, fabs(solver->inflow[solver->mover[k]]));
    for (int k = solver->n_mover; k < solver->n_end; k++) {
        const int throat = solver->mover[k];
        const double moves =
            menisci_potential(&flow->menisci, throat, problem->reference);
        const double sum = fabs(moves) + fabs(flow->excess[throat]);
        scale = fmax(scale, ROUNDING_SHARE * flow->response[throat] * sum);
    }
    return scale;
}
