// SPDX-License-Identifier: GPL-3.0-or-later
// What is inside struct foresight, for the files that make it up only.
#ifndef CRAQUELURE_FORESEE_STATE_H
#define CRAQUELURE_FORESEE_STATE_H

#include "equilibrium_state.h"
#include "joint_lanes.h"
#include "settle_lane.h"

struct foresight {
    struct equilibrium *of;
    int n_expected; // loads
    const struct vector *force;
    int found, used; // lanes that are known, and of them those that were asked for
    int present;     // lane that the joints have not come to yet, or -1 [foreseen.c]
    int sight; // lanes to look at: one after a crack, then twice as many each time
    bool has_looked; // with as many cracks, grains that left and factors
    int n_crack, n_gone, factors;
    struct vector *load;              // (n)
    struct net_load taken_off[LANES]; // of the loads
    double largest_load[LANES];       // up to and with each
    double *applied;                  // (n * GRAIN) loads
    double *left;         // (n * GRAIN) to begin with, by the law of the factor; then
                          // what is left, and what joints do to held grains
    double *moved, *step; // (n * GRAIN)
    struct displacement *from; // (n) the last equilibrium when these began
    struct lane_sums sums;     // where they moved
    uint8_t *touches_now;      // (n_joint) a bit a lane
    int n_row, row_capacity;
    struct lane_row *row;
    bool *touches;        // (row_capacity * LANES)
    double *given, *more; // (row_capacity * LANES)
    struct settler *settler;
};

// What is left where the grains have MOVED, in LEFT, and the SUMS; the most left in any
// of COUNT lanes.
double find_left_lanes(struct equilibrium *equilibrium, int count);

// Whether the next lanes have been looked at as bonds are, and are looked at. The trial
// goes to where LANE has led.
bool has_looked(const struct equilibrium *equilibrium);
void look_ahead(struct equilibrium *equilibrium);
void go_to_lane(struct equilibrium *equilibrium, int lane);

#endif
