// SPDX-License-Identifier: GPL-3.0-or-later
// Flow of viscous liquid inside its clusters [K 3.10], with its menisci.
//
// Poiseuille's law holds in every throat (K 3.10 lost its 8): mass flow is
// pi r^4 / (8 nu L) times the fall of pressure, over the part of L that is filled. A
// throat with gas at one end has its meniscus there. At the open surface gas touches
// nodes that are liquid still, and pass liquid on, until a throat at them has emptied:
// a throat with such nodes at both ends empties from its middle.
//
// A throat that is partly empty has a moving meniscus, held at the throat's capillary
// pressure. In a full one the meniscus stays at the mouth while the pressure behind it
// is above that, and liquid flows to it as fast as it evaporates; otherwise it recedes,
// losing more than flows in. Which do is an obstacle problem with a symmetric M-matrix:
// it has one solution. In each round all menisci that must stop do, and those begin to
// move that fall short most. Either only raises pressures, so none changes back
// (Hintermueller, Ito and Kunisch 2002 change all at once; most would stop again).
#pragma once

#include "meniscus.h"
#include "occupancy.h"

struct loss;
struct flow_solver; // what is kept from step to step, and room to solve in

struct liquid_flow {
    const struct network *network;
    struct menisci menisci;
    double step; // share of its liquid that a cluster may lose until its flow is found
                 // again; 0: none
    double *conductance; // (n_throat) of a full throat, scaled
    double *resistance;  // (n_throat) its inverse
    bool *moving;        // (n_throat) its meniscus, when last solved for
    // (n_throat) each, where vapour follows the pressure of menisci, else NULL.
    double *response; // of a stationary one: d evaporation / d pressure
    double *excess; // its pressure above the entry pressure, for which the evaporation
                    // is given
    double *found;  // its excess as found; of one that moves: its loss
    bool wants_pressures; // also of clusters whose losses are known without them
    double *pressure; // (n_node) of the liquid less that of the gas, in menisci's unit,
                      // 0 in gas: if they were wanted
    double residual;  // largest so far, of what flows
    int64_t rounds, solutions; // in which menisci were found; clusters solved
    struct flow_solver *solver;
};

// For a network full of liquid. STEP as above. Takes over MENISCI. The caller frees it
// with liquid_flow_free.
struct liquid_flow liquid_flow_init(const struct occupancy *occupancy, double length,
                                    double step, struct menisci menisci);

// THROAT has emptied, and OCCUPANCY has followed.
void liquid_flow_follow(struct liquid_flow *flow, const struct occupancy *occupancy,
                        int throat);

// Finds which throats lose liquid, or gain it (a negative rate), when each evaporates
// EVAPORATION[throat]: LOSS, with room for one entry a throat, and their number N_LOSS,
// in no order. The losses of a cluster add up to what it evaporates.
//
// Where vapour follows pressure, flow->moving is given and must include all throats
// partly empty; clusters of a single throat are left out: nothing flows in them.
//
// STATUS_NOT_CONVERGED if menisci are not found or the balance does not close.
enum status liquid_flow_find(struct liquid_flow *flow,
                             const struct occupancy *occupancy,
                             const double *evaporation, struct loss *loss, int *n_loss,
                             struct reason *reason);

// The same for the throats of one CLUSTER. It reads the array EVAPORATION of the last
// call above, which the caller may have changed since.
enum status liquid_flow_find_in(struct liquid_flow *flow, int cluster,
                                struct loss *loss, int *n_loss, struct reason *reason);

// Forgets what is remembered only for speed: the next call starts from the menisci
// alone, as a run does that continues from a checkpoint.
void liquid_flow_forget(struct liquid_flow *flow, const struct occupancy *occupancy);

// From now on vapour follows the pressure of menisci that stay.
void liquid_flow_respond(struct liquid_flow *flow);

void liquid_flow_free(struct liquid_flow *flow);
