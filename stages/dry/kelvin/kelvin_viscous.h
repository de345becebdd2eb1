// SPDX-License-Identifier: GPL-3.0-or-later
// Viscous liquid whose menisci have vapour pressures of their own (Kelvin).
//
// Each throat that gas touches has one meniscus. One that moves is as curved as its
// throat makes it; one that stays is as curved as the pressure says that the flow has
// there, never more than its throat can hold, and flat or bulging where the liquid is
// pressed against it. A node has the mean of their potentials by sections, as it shares
// out what it evaporates. What evaporates follows from the pressures, the flow from
// what evaporates: a fixed point.
//
// What a meniscus evaporates rises with its pressure, and the flow is solved with that
// response: so the iteration converges for any viscosity. A cluster of one throat is
// left to kelvin_menisci.h: nothing flows in it, and it waits where vapour would
// condense. A cluster of several waits too if none of its menisci moves: then their
// response determines its pressure.
#pragma once

#include "dry/liquid/viscous.h"
#include "kelvin_menisci.h"
#include "sparse/anderson.h"

struct kelvin_viscous {
    struct kelvin_menisci *kelvin;
    struct liquid_flow *flow;
    double *excess; // (n_throat) flow->excess when last found; -1: no meniscus yet
    bool *waited;   // (n_throat) no meniscus of its cluster moved then
    double unit;    // p_c M / (rho R T) where p_c is the flow's unit of pressure
    int64_t rounds; // in which flow and vapour were found

    // The menisci whose pressure the flow determines.
    int n;
    int *body;          // (n) place in KELVIN
    double *x, *mapped; // (n) potentials, and what the fixed-point map makes of them
    double *lumped; // (n) -d evaporation / d potential, if all of its cluster change
    double *single; // (n) the same if it changes alone
    struct anderson anderson;
};

// KELVIN and FLOW must live as long. The caller frees it with kelvin_viscous_free.
struct kelvin_viscous kelvin_viscous_init(struct kelvin_menisci *kelvin,
                                          struct liquid_flow *flow);

// Sets LOSSES to what each throat loses, or takes up (negative), in ascending throats,
// for the OCCUPANCY of now.
//
// STATUS_NOT_CONVERGED if flow and vapour are not found. Anderson's acceleration first,
// then Newton's method with differences; both have a limit.
enum status kelvin_viscous_find(struct kelvin_viscous *coupling,
                                struct occupancy *occupancy, struct losses *losses,
                                struct reason *reason);

void kelvin_viscous_state(struct kelvin_viscous *coupling,
                          struct checkpoint_stream *stream);

void kelvin_viscous_free(struct kelvin_viscous *coupling);
