// SPDX-License-Identifier: GPL-3.0-or-later
// What is kept of the flow in clusters from event to event, and room to find it in.
#ifndef CRAQUELURE_FLOW_SOLVER_H
#define CRAQUELURE_FLOW_SOLVER_H

#include "cluster_laplacian.h"
#include "cluster_members.h"
#include "elimination/kron.h"
#include "sparse/cholmod_serial.h"
#include "viscous.h"

// Error of a node's balance that is aimed at, relative to the largest flow in its
// cluster.
static const double FLOW_TARGET = 5e-13;

// What is known of a cluster from before.
struct cluster_memory {
    struct cluster_laplacian *graph; // NULL: none
    int *node;                       // (graph->n) of its rows
    int reference;     // potentials are above that at which gas enters this throat, -1:
                       // there are none
    double resistance; // at least that of all its throats one after the other,
    int size;          // of as many
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

    // Of the cluster at hand.
    int n_mover, *mover;   // (n_mover) throats whose meniscus moves, and after them, to
    int n_end;             // (n_end), those that stay and whose vapour responds
    struct graph_arm *arm; // from liquid ends to them, in their order
    int n_node, *node;
    int *site; // (n_node of the network) in kron, -1: none
    double *level;
    struct graph_link *link;
};

// A cluster of liquid at this step. Its unknowns are the potentials at nodes that
// liquid fills and passes through.
struct cluster_problem {
    int cluster, n_throat;
    int reference;      // throat that gas enters most easily: potentials are above its
    double evaporation; // of all its throats
    double turnover;    // the same, what they take up added to what they evaporate
    int n_meniscus, n_partial; // of them, in throats partly empty
    double margin;             // of the reference over the next throat that gas enters
    double flow;               // scale of the flows in it
};

// Keeps OCCUPANCY, which must live as long. The caller frees it with flow_solver_free.
struct flow_solver *flow_solver_make(const struct occupancy *occupancy);
void flow_solver_free(struct flow_solver *solver);

// The scale of the flows: the largest to or from a moving meniscus, or what evaporates.
double flow_scale(const struct liquid_flow *flow,
                  const struct cluster_problem *problem);

// Nothing is remembered of the clusters as they were.
void flow_solver_forget(struct flow_solver *solver, const struct occupancy *occupancy);

// THROAT has emptied.
void flow_solver_follow(struct flow_solver *solver, const struct occupancy *occupancy,
                        int throat);

// Whether a throat holds all it can.
bool throat_is_full(const struct occupancy *occupancy, int throat);

// The nodes at a throat's liquid ends; returns how many there are.
int liquid_ends(const struct liquid_flow *flow, int throat, int end[2]);

// From the meniscus of THROAT to each of its N liquid ends.
double meniscus_arm(const struct liquid_flow *flow, int throat, int n);

// The same where the vapour responds, up to where the meniscus would evaporate
// EVAPORATION; what is taken from each of its N liquid ends; potential there.
double response_arm(const struct liquid_flow *flow, int throat, int n);
double extracted_from_end(const struct liquid_flow *flow, int throat, int n);
double end_potential(const struct liquid_flow *flow, int throat, int reference);

// Of NODE in CLUSTER.
double node_potential(const struct flow_solver *solver, int cluster, int node);

// Lists the cluster's nodes in the solver's NODE.
void list_nodes(struct liquid_flow *flow, const struct cluster_problem *problem);

// Of the cluster at hand, on either list; -1: none.
int first_throat(const struct flow_solver *solver,
                 const struct cluster_problem *problem, enum throat_list list);

// The potentials go to the solver's, and the graph is gone, if there was one.
void free_graph(struct flow_solver *solver, struct cluster_memory *memory);

#endif
