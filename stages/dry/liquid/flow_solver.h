// SPDX-License-Identifier: GPL-3.0-or-later
// What is remembered of the flow in clusters from event to event, and the workspace of
// its solvers. Potentials are liquid pressure plus weight, in the units of meniscus.h.
// For the files of this folder only. Nothing here is in a checkpoint: it only saves
// time, and is forgotten at moments that do not depend on checkpoints (resume.c).
#pragma once

#include "cluster_laplacian.h"
#include "cluster_members.h"
#include "elimination/kron.h"
#include "sparse/cholmod_serial.h"
#include "viscous.h"

// Target of the error of a node's balance, relative to the largest flow in its cluster;
// and what is still accepted. A flow that is kept for a while need not be exact.
static inline double flow_target(const struct liquid_flow *flow)
{
    return flow->step > 0 ? 1e-6 : 5e-13;
}

static inline double flow_tolerance(const struct liquid_flow *flow)
{
    return flow->step > 0 ? 1e-4 : 1e-11;
}

// What is known of a cluster from previous steps. It owns .graph and .node. Identities
// of clusters are given out again, so flow_solver_follow must see every event.
struct cluster_memory {
    struct cluster_laplacian *graph; // NULL: none
    int *node;                       // (graph->n) of its rows
    int reference;     // potentials are relative to the entry potential of this throat;
                       // -1: there are no potentials
    double resistance; // at least that of all its throats in series,
    int size;          // when it had so many throats
    // When its flow was last found: the volume of its liquid (0: it is to be found) and
    // what evaporated; since then, the volume of the throats that emptied or refilled.
    double liquid, evaporation, changed;
};

struct flow_solver {
    const struct occupancy *occupancy;
    const double *evaporation;
    cholmod_common common;
    struct cluster_members members;
    int capacity;
    struct cluster_memory *cluster; // (capacity) by identity
    struct kron kron;
    int *row;   // (n_node) in the graph of its cluster, -1: none
    int *entry; // (n_throat) of its link in the graph of its cluster, -1: none
    // In two parts: across a wide throat potentials differ by less than the last digit.
    struct compensated *potential; // (n_node) where no graph has it
    double *inflow;                // (n_throat) to each meniscus that moves

    // The cluster being solved.
    int n_mover, *mover;   // (n_mover) throats whose meniscus moves, and after them, up
    int n_end;             // to n_end, stationary ones whose evaporation responds
    struct graph_arm *arm; // from liquid ends to them, in their order
    int n_node, *node;
    int *site; // (n_node of the network) in kron, -1: none
    double *level;
    struct graph_link *link;
};

// The flow problem of one cluster at this step. Its unknowns are the potentials at
// nodes that are filled with liquid and join at least two throats of it.
struct cluster_problem {
    int cluster, n_throat;
    int reference;      // throat that gas enters most easily: zero of the potentials
    double evaporation; // of all its throats, condensation subtracted
    double turnover;    // the same with condensation added: a scale, never cancelled
    int n_meniscus, n_partial; // menisci; those of them in throats partly empty
    double margin;             // entry potential of the reference above the next one's
    double flow;               // scale of the flows in it
    double error, target;      // of the balances, relative to that: the largest
};

// Keeps OCCUPANCY, which must live as long. The caller frees it with flow_solver_free.
struct flow_solver *flow_solver_create(const struct occupancy *occupancy);
void flow_solver_free(struct flow_solver *solver);

// The scale of the flows: the largest to or from a moving meniscus, or what evaporates.
double flow_scale(const struct liquid_flow *flow,
                  const struct cluster_problem *problem);

// Forgets all clusters: the next solution starts from scratch, as after a restart.
void flow_solver_forget(struct flow_solver *solver, const struct occupancy *occupancy);

// THROAT has emptied and OCCUPANCY has followed: moves what is remembered to the
// clusters of now.
void flow_solver_follow(struct flow_solver *solver, const struct occupancy *occupancy,
                        int throat);

// Whether a throat holds all it can.
bool throat_is_full(const struct occupancy *occupancy, int throat);

// The nodes at a throat's liquid ends; returns how many there are.
int liquid_ends(const struct liquid_flow *flow, int throat, int end[2]);

// Conductance from the meniscus of THROAT to each of its N liquid ends.
double meniscus_arm(const struct liquid_flow *flow, int throat, int n);

// For a meniscus whose evaporation responds to the pressure: conductance from each of
// its N liquid ends to the potential at which it evaporates solver->evaporation; the
// part of that evaporation extracted from each end (all of 1/N without response); that
// potential.
double response_arm(const struct liquid_flow *flow, int throat, int n);
double extracted_from_end(const struct liquid_flow *flow, int throat, int n);
double end_potential(const struct liquid_flow *flow, int throat, int reference);

// Conductance from one liquid end of THROAT to the other; 0 where its meniscus moves.
double link_of_ends(const struct liquid_flow *flow, int throat);

// Potential of NODE in CLUSTER, relative to the cluster's reference throat.
double node_potential(const struct flow_solver *solver, int cluster, int node);

// Mean potential of the liquid ends of THROAT in CLUSTER, *N of them; 0 for none.
double potential_of_ends(const struct liquid_flow *flow, int cluster, int throat,
                         int *n);

// Lists the cluster's nodes in the solver's NODE.
void list_nodes(struct liquid_flow *flow, const struct cluster_problem *problem);

// First throat of the cluster on LIST; -1: none. The solver's members have the next.
int first_throat(const struct flow_solver *solver,
                 const struct cluster_problem *problem, enum throat_list list);

// The same for its menisci.
static inline int first_meniscus(const struct liquid_flow *flow,
                                 const struct cluster_problem *problem)
{
    return first_throat(flow->solver, problem, LIST_MENISCI);
}

// The throat after THROAT on its list; -1: none.
static inline int next_throat(const struct liquid_flow *flow, int throat)
{
    return flow->solver->members.next[throat];
}

// Frees the cluster's graph, if it has one; its potentials are kept in the solver.
void free_graph(struct flow_solver *solver, struct cluster_memory *memory);
