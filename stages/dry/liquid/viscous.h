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
// it has one solution. From the first round on those that must stop do, and those that
// must most begin; as either only raises pressures, none comes back (Hintermueller, Ito
// and Kunisch 2002 change all at once, and most of those would stop again).
#ifndef CRAQUELURE_VISCOUS_H
#define CRAQUELURE_VISCOUS_H

#include "meniscus.h"
#include "occupancy.h"

struct loss;
struct flow_solver; // what is kept from step to step, and room to solve in

struct liquid_flow {
    const struct network *network;
    struct menisci menisci;
    double *conductance; // (n_throat) of a full throat, scaled
    double *resistance;  // (n_throat) its inverse
    bool *moving;        // (n_throat) its meniscus, when last solved for
    // Where vapour follows the pressure of menisci, else NULL. (n_throat)
    double *response; // of one that stays: rise of what evaporates with the pressure
    double
        *excess;   // pressure over that at which it moves, where EVAPORATION evaporates
    double *found; // what that is then; of one that moves: what it loses
    bool wants_pressures; // where they decide nothing, too
    double *pressure; // (n_node) of the liquid less that of the gas, in menisci's unit,
                      // 0 in gas: if they were wanted
    double residual;  // largest so far, of what flows
    int64_t rounds, solutions; // in which menisci were found; clusters solved
    struct flow_solver *solver;
};

// For a network full of liquid. Takes over MENISCI. The caller frees it with
// liquid_flow_free.
struct liquid_flow liquid_flow_make(const struct occupancy *occupancy, double length,
                                    struct menisci menisci);

// THROAT has emptied, and OCCUPANCY have followed.
void liquid_flow_follow(struct liquid_flow *flow, const struct occupancy *occupancy,
                        int throat);

// Finds which throats lose liquid, or gain it (a negative rate), when each evaporates
// EVAPORATION[throat]: LOSS, with room for one entry a throat, and their number N_LOSS,
// in no order. The losses of a cluster add up to what it evaporates.
//
// Where vapour follows pressure MOVING is given, partly empty throats among them, and
// throats by themselves are left out: in them nothing flows.
//
// STATUS_NOT_CONVERGED if menisci are not found or the balance does not close.
enum status liquid_flow_find(struct liquid_flow *flow,
                             const struct occupancy *occupancy,
                             const double *evaporation, struct loss *loss, int *n_loss,
                             struct reason *reason);

// What is remembered from call to call only to be faster is not any more: the next
// goes on from the menisci alone.
void liquid_flow_forget(struct liquid_flow *flow, const struct occupancy *occupancy);

// From now on vapour follows the pressure of menisci that stay.
void liquid_flow_respond(struct liquid_flow *flow);

void liquid_flow_free(struct liquid_flow *flow);

#endif
