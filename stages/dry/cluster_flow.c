// SPDX-License-Identifier: GPL-3.0-or-later
#include "cluster_flow.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// A cluster of at least this many nodes has a graph, which is made anew when this part
// of its nodes have left.
enum { GRAPH_NODES = 150, REFINEMENTS = 8 };
static const double MOST_LEFT = 0.06;

// --- one throat ----------------------------------------------------------------------

bool throat_is_full(const struct phases *phases, int throat)
{
    return !(phases_saturation(phases, throat) < 1);
}

bool passes_on(const struct phases *phases, int node)
{
    return phases->clusters.joins[node] && phases->liquid_beside[node] > 1;
}

int liquid_ends(const struct liquid_flow *flow, int throat, int end[2])
{
    int n = 0;
    for (int k = 0; k < 2; k++) {
        const int node = flow->network->throat_nodes[throat][k];
        if (passes_on(flow->solver->phases, node)) end[n++] = node;
    }
    return n;
}

double meniscus_arm(const struct liquid_flow *flow, int throat, int n)
{
    return n * flow->conductance[throat] /
           phases_saturation(flow->solver->phases, throat);
}

double node_potential(const struct flow_solver *solver, int cluster, int node)
{
    const struct liquid_graph *graph = solver->cluster[cluster].graph;
    return compensated_value(graph ? graph->potential[solver->row[node]]
                                   : solver->potential[node]);
}

static int first_throat(const struct flow_solver *solver, const struct piece *piece,
                        enum throat_list list)
{
    return throat_lists_first(&solver->lists, piece->cluster, list);
}

static void add_node(struct flow_solver *solver, int node)
{
    if (solver->site[node] >= 0) return;
    solver->site[node] = solver->n_node;
    solver->node[solver->n_node++] = node;
}

void list_nodes(struct liquid_flow *flow, const struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    solver->n_node = 0;
    for (enum throat_list l = 0; l < LISTS; l++)
        for (int t = first_throat(solver, piece, l); t >= 0;
             t = solver->lists.next[t]) {
            int end[2];
            const int n = liquid_ends(flow, t, end);
            for (int e = 0; e < n; e++)
                add_node(solver, end[e]);
        }
    for (int k = 0; k < solver->n_node; k++)
        solver->site[solver->node[k]] = -1;
}

static void list_movers(struct liquid_flow *flow, const struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    solver->n_mover = 0;
    for (int t = first_throat(solver, piece, LIST_MENISCI); t >= 0;
         t = solver->lists.next[t])
        if (flow->moving[t]) solver->mover[solver->n_mover++] = t;
}

// The largest flow to or from a moving meniscus, or what evaporates.
static double flow_scale(const struct flow_solver *solver, const struct piece *piece)
{
    double scale = piece->evaporation;
    for (int k = 0; k < solver->n_mover; k++)
        scale = fmax(scale, fabs(solver->inflow[solver->mover[k]]));
    return scale;
}

// --- by elimination ------------------------------------------------------------------

static double fall_between_movers(const void *context, int b, int a)
{
    const struct liquid_flow *flow = context;
    return menisci_potential(&flow->menisci, flow->solver->mover[b],
                             flow->solver->mover[a]);
}

static void link_throat(struct liquid_flow *flow, int throat)
{
    struct flow_solver *solver = flow->solver;
    int end[2];
    const int n = liquid_ends(flow, throat, end);
    for (int e = 0; e < n; e++)
        kron_take(&solver->kron, solver->site[end[e]], solver->charge[throat] / n);
    if (n == 2)
        kron_link(&solver->kron, solver->site[end[0]], solver->site[end[1]],
                  flow->conductance[throat]);
}

static void link_mover(struct liquid_flow *flow, int k)
{
    struct flow_solver *solver = flow->solver;
    int end[2];
    const int n = liquid_ends(flow, solver->mover[k], end);
    for (int e = 0; e < n; e++)
        kron_link(&solver->kron, solver->site[end[e]], solver->n_node + k,
                  meniscus_arm(flow, solver->mover[k], n));
}

// Returns by how much what flows to the menisci differs from what is taken on the way.
static double find_inflow(struct liquid_flow *flow, const struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    double sum = piece->evaporation;
    for (int k = 0; k < solver->n_mover; k++) {
        const int throat = solver->mover[k];
        solver->inflow[throat] = kron_flow(&solver->kron, k, fall_between_movers, flow);
        sum += solver->inflow[throat] - solver->charge[throat];
    }
    return fabs(sum);
}

static void keep_potentials(struct liquid_flow *flow, const struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    struct cluster_memory *memory = &solver->cluster[piece->cluster];
    double *level = solver->level;
    for (int k = 0; k < solver->n_mover; k++)
        level[solver->n_node + k] =
            menisci_potential(&flow->menisci, solver->mover[k], piece->reference);
    kron_potentials(&solver->kron, level);
    for (int k = 0; k < solver->n_node; k++) {
        const int node = solver->node[k];
        struct compensated *potential =
            memory->graph ? &memory->graph->potential[solver->row[node]]
                          : &solver->potential[node];
        *potential = (struct compensated){.value = level[k]};
    }
    memory->reference = piece->reference;
}

// The nodes are listed. Returns the error of the balance.
static double solve_by_elimination(struct liquid_flow *flow, struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    kron_begin(&solver->kron, solver->n_node, solver->n_mover);
    for (int k = 0; k < solver->n_node; k++)
        solver->site[solver->node[k]] = k;
    for (enum throat_list l = 0; l < LISTS; l++)
        for (int t = first_throat(solver, piece, l); t >= 0; t = solver->lists.next[t])
            if (!flow->moving[t]) link_throat(flow, t);
    for (int k = 0; k < solver->n_mover; k++)
        link_mover(flow, k);
    for (int k = 0; k < solver->n_node; k++)
        solver->site[solver->node[k]] = -1;
    kron_eliminate(&solver->kron);
    const double lack = find_inflow(flow, piece);
    keep_potentials(flow, piece);
    piece->flow = flow_scale(solver, piece);
    return lack > 0 ? lack / piece->flow : 0;
}

// --- by a graph that is kept ---------------------------------------------------------

static void free_graph(struct flow_solver *solver, struct cluster_memory *memory)
{
    struct liquid_graph *graph = memory->graph;
    for (int k = 0; graph && k < graph->n; k++) {
        if (graph->present[k] == 0) continue;
        solver->potential[memory->node[k]] = graph->potential[k];
        solver->row[memory->node[k]] = -1;
    }
    liquid_graph_free(graph);
    free(memory->node);
    memory->graph = NULL;
    memory->node = NULL;
}

static int list_links(struct liquid_flow *flow, const struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    int n_link = 0;
    for (enum throat_list l = 0; l < LISTS; l++)
        for (int t = first_throat(solver, piece, l); t >= 0;
             t = solver->lists.next[t]) {
            int end[2];
            solver->entry[t] = -1;
            if (liquid_ends(flow, t, end) != 2) continue;
            solver->entry[t] = n_link;
            solver->link[n_link++] =
                (struct graph_link){solver->site[end[0]], solver->site[end[1]],
                                    flow->moving[t] ? 0 : flow->conductance[t]};
        }
    return n_link;
}

// The nodes are listed.
static bool make_graph(struct liquid_flow *flow, const struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    struct cluster_memory *memory = &solver->cluster[piece->cluster];
    const int n = solver->n_node;
    for (int k = 0; k < n; k++)
        solver->site[solver->node[k]] = k;
    const int n_link = list_links(flow, piece);
    for (int k = 0; k < n; k++)
        solver->site[solver->node[k]] = -1;
    int *row = NEW_ARRAY(int, n), *entry = NEW_ARRAY(int, n_link);
    memory->graph =
        liquid_graph_make(&solver->common, n, n_link, solver->link, row, entry);
    if (memory->graph) {
        memory->node = NEW_ARRAY(int, n);
        for (int k = 0; k < n; k++) {
            memory->node[row[k]] = solver->node[k];
            solver->row[solver->node[k]] = row[k];
            if (memory->reference >= 0)
                memory->graph->potential[row[k]] = solver->potential[solver->node[k]];
        }
        for (enum throat_list l = 0; l < LISTS; l++)
            for (int t = first_throat(solver, piece, l); t >= 0;
                 t = solver->lists.next[t])
                if (solver->entry[t] >= 0) solver->entry[t] = entry[solver->entry[t]];
    }
    free(row);
    free(entry);
    return memory->graph;
}

// The cluster's graph; NULL if it is too small for one.
static struct liquid_graph *find_graph(struct liquid_flow *flow,
                                       const struct piece *piece)
{
    struct flow_solver *solver = flow->solver;
    struct cluster_memory *memory = &solver->cluster[piece->cluster];
    const struct liquid_graph *old = memory->graph;
    if (old && old->n_left <= MOST_LEFT * old->n) return memory->graph;
    free_graph(solver, memory);
    list_nodes(flow, piece);
    if (solver->n_node >= GRAPH_NODES) make_graph(flow, piece);
    return memory->graph;
}

// Potentials are above that of another throat now.
static void change_reference(struct liquid_flow *flow, const struct piece *piece)
{
    struct cluster_memory *memory = &flow->solver->cluster[piece->cluster];
    if (memory->reference >= 0 && memory->reference != piece->reference) {
        const double rise =
            menisci_potential(&flow->menisci, memory->reference, piece->reference);
        for (int k = 0; k < memory->graph->n; k++)
            compensated_add(&memory->graph->potential[k], rise);
    }
    memory->reference = piece->reference;
}

// What menisci take that stay, and the arms to those that move.
static void describe_menisci(struct liquid_flow *flow, const struct piece *piece,
                             struct liquid_graph *graph)
{
    struct flow_solver *solver = flow->solver;
    int n_arm = 0;
    for (int k = 0; k < graph->n; k++)
        graph->source[k] = 0;
    for (int t = first_throat(solver, piece, LIST_MENISCI); t >= 0;
         t = solver->lists.next[t]) {
        int end[2];
        const int n = liquid_ends(flow, t, end);
        if (solver->entry[t] >= 0 && n == 2)
            liquid_graph_set(graph, solver->entry[t],
                             flow->moving[t] ? 0 : flow->conductance[t]);
        for (int e = 0; e < n; e++) {
            const int row = solver->row[end[e]];
            if (flow->moving[t])
                solver->arm[n_arm++] = (struct graph_arm){
                    row, meniscus_arm(flow, t, n),
                    menisci_potential(&flow->menisci, t, piece->reference)};
            else
                graph->source[row] -= solver->charge[t] / n;
        }
    }
    liquid_graph_set_arms(graph, n_arm, solver->arm);
}

// Movers and arms come in one order.
static void collect_inflow(struct liquid_flow *flow, const struct liquid_graph *graph)
{
    struct flow_solver *solver = flow->solver;
    const struct graph_arm *arm = graph->arm;
    for (int k = 0; k < solver->n_mover; k++) {
        int end[2];
        const int throat = solver->mover[k], n = liquid_ends(flow, throat, end);
        double sum = 0;
        for (int e = 0; e < n; e++, arm++) {
            const struct compensated level = {.value = arm->level};
            sum += arm->conductance *
                   compensated_difference(graph->potential[arm->a], level);
        }
        solver->inflow[throat] = sum;
    }
}

// What the worst balance lacks, of the largest flow; 0 where nothing flows, as between
// menisci that are all alike.
static double graph_error(struct liquid_flow *flow, struct piece *piece,
                          struct liquid_graph *graph)
{
    const double lack = liquid_graph_lack(graph);
    collect_inflow(flow, graph);
    piece->flow = flow_scale(flow->solver, piece);
    return lack > 0 ? lack / piece->flow : 0;
}

static double solve_by_graph(struct liquid_flow *flow, struct piece *piece,
                             struct liquid_graph *graph)
{
    change_reference(flow, piece);
    describe_menisci(flow, piece, graph);
    double error = graph_error(flow, piece, graph);
    for (int k = 0; k < REFINEMENTS && !(error <= FLOW_AIM); k++) {
        const bool good = liquid_graph_correct(graph, FLOW_AIM * piece->flow);
        error = graph_error(flow, piece, graph);
        if (!good) break;
    }
    return error;
}

enum status cluster_flow_solve(struct liquid_flow *flow, struct piece *piece,
                               struct reason *reason)
{
    struct flow_solver *solver = flow->solver;
    double error = INFINITY;
    list_movers(flow, piece);
    struct liquid_graph *graph = find_graph(flow, piece);
    if (graph) error = solve_by_graph(flow, piece, graph);
    if (!(error < FLOW_TOLERANCE)) {
        free_graph(solver, &solver->cluster[piece->cluster]);
        list_nodes(flow, piece);
        error = solve_by_elimination(flow, piece);
    }
    if (!(error < FLOW_TOLERANCE))
        return refuse(reason, STATUS_NOT_CONVERGED,
                      "the liquid's balance closes to %.3g of its largest flow only, "
                      "needed is %g (%d unknowns)",
                      error, FLOW_TOLERANCE, solver->n_node);
    flow->residual = fmax(flow->residual, error);
    return STATUS_OK;
}

// --- from event to event -------------------------------------------------------------

static void reserve(struct flow_solver *solver, int n_id)
{
    while (solver->capacity < n_id) {
        const int before = solver->capacity;
        GROW_ARRAY(solver->cluster, solver->capacity, solver->capacity);
        for (int c = before; c < solver->capacity; c++)
            solver->cluster[c] = (struct cluster_memory){.reference = -1};
    }
}

// NODE is gas now.
static void cut_node(struct flow_solver *solver, struct cluster_memory *memory,
                     int node)
{
    if (solver->row[node] < 0) return;
    liquid_graph_cut(memory->graph, solver->row[node]);
    solver->row[node] = -1;
}

// The ends of THROAT have left with it for a new cluster.
static void part_with(struct flow_solver *solver, const struct network *network,
                      struct cluster_memory *memory, int throat)
{
    solver->entry[throat] = -1;
    for (int end = 0; end < 2; end++) {
        const int node = network->throat_nodes[throat][end], row = solver->row[node];
        if (row < 0) continue;
        solver->potential[node] = memory->graph->potential[row];
        liquid_graph_leave(memory->graph, row);
        solver->row[node] = -1;
    }
}

void flow_solver_follow(struct flow_solver *solver, const struct phases *phases,
                        int throat)
{
    const struct clusters *clusters = &phases->clusters;
    const struct incidence *incidence = &phases->incidence;
    reserve(solver, clusters->n_id);
    const int old = solver->lists.cluster[throat];
    struct cluster_memory *memory = &solver->cluster[old];
    const int32_t *node = phases->network->throat_nodes[throat];
    for (int end = 0; end < 2; end++)
        cut_node(solver, memory, node[end]);
    throat_lists_follow(&solver->lists, clusters, throat);
    for (int k = 0; k < clusters->n_moved; k++) {
        const int moved = clusters->moved[k];
        part_with(solver, phases->network, memory, moved);
        throat_lists_follow(&solver->lists, clusters, moved);
        solver->cluster[clusters->of_throat[moved]] =
            (struct cluster_memory){.reference = memory->reference,
                                    .resistance = memory->resistance,
                                    .size = memory->size};
    }
    for (int end = 0; end < 2; end++)
        for (int k = incidence->offset[node[end]]; k < incidence->offset[node[end] + 1];
             k++)
            throat_lists_follow(&solver->lists, clusters, incidence->throat[k]);
    if (clusters->size[old] > 0) return;
    free_graph(solver, memory);
    *memory = (struct cluster_memory){.reference = -1};
}

void flow_solver_forget(struct flow_solver *solver, const struct phases *phases)
{
    for (int c = 0; c < solver->capacity; c++) {
        free_graph(solver, &solver->cluster[c]);
        solver->cluster[c] = (struct cluster_memory){.reference = -1};
    }
    reserve(solver, phases->clusters.n_id);
    throat_lists_free(&solver->lists);
    solver->lists = throat_lists_make(&phases->clusters, phases->network->n_throat);
}

struct flow_solver *flow_solver_make(const struct phases *phases)
{
    const int n_node = phases->network->n_node, n_throat = phases->network->n_throat;
    struct flow_solver *solver = NEW_ARRAY(struct flow_solver, 1);
    *solver = (struct flow_solver){
        .lists = throat_lists_make(&phases->clusters, n_throat),
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
    reserve(solver, phases->clusters.n_id);
    plain_cholmod_start(&solver->common);
    return solver;
}

void flow_solver_free(struct flow_solver *solver)
{
    if (!solver) return;
    for (int c = 0; c < solver->capacity; c++)
        free_graph(solver, &solver->cluster[c]);
    cholmod_finish(&solver->common);
    throat_lists_free(&solver->lists);
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
