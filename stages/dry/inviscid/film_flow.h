// SPDX-License-Identifier: GPL-3.0-or-later
// Flow in a network of films, where liquid goes only as far as there is some: an
// obstacle problem. At each site
//     surplus_i = taken_i + sum_j conductance_ij (level_i - level_j)
// is what is taken from it and flows away through films. Either this is 0, as films
// bring what leaves, or the level is the least that it can be, and the site supplies
// the surplus, above 0, from what it stores:
//     level >= least,   surplus >= 0,   (level - least) surplus = 0.
#pragma once

#include "elimination/conductance_matrix.h"

#include <stdbool.h>

struct film_factor; // film_balance.h

// The arrays belong to the caller. Units as in conductance_matrix.h: levels are
// potentials; what is taken is a flow, 0 or more.
struct film_flow {
    const struct conductance_matrix *matrix; // of all n sites
    const int *place;                        // (n) what names a site, 0 or more
    const double *taken, *least;             // (n)
    struct film_factor *factor; // of earlier flows, on some of the same places
    bool *held;                 // (n) the level is the least; first a guess, with one
                                // such site in each connected part of the network
    struct compensated *level;  // (n) first a guess where not held, in each part of the
                                // network no higher than the highest least there
    double *surplus;            // (n) 0 where not held
    int rounds, iterations;     // added to
};

// What films bring to site I, once found; below 0: what they take from it.
static inline double film_flow_inflow(const struct film_flow *flow, int i)
{
    return flow->taken[i] - flow->surplus[i];
}

// Finds HELD, LEVEL and SURPLUS. What does not balance at sites that are not held is
// TOLERANCE in all at most, or what rounding of levels makes. False if that is not
// reached.
bool film_flow_solve(struct film_flow *flow, double tolerance);
