// SPDX-License-Identifier: GPL-3.0-or-later
// What is inside struct foresight, for the files that make it up only.
#ifndef CRAQUELURE_FORESEE_STATE_H
#define CRAQUELURE_FORESEE_STATE_H

#include "equilibrium_state.h"
#include "joint_lanes.h"
#include "load_path.h"
#include "settle_lane.h"

struct foresight {
    struct equilibrium *of;
    int n_expected; // loads
    const struct vector *force;
    int n_lane, found, used; // loads side by side, where those end that are known, and
                             // how many were asked for
    int present;   // lane that the joints have not come to yet, or -1 [foreseen.c]
    int sight;     // lanes to look at
    bool has_hint; // the next lane leads near its equilibrium
    int n_crack, n_gone, factors;     // that there were when these were
    struct load_path path;            // of the loads since all began, and of these
    int passed, first;                // that are past, and before the lanes
    bool has_begun, has_begun_lanes;  // the way through the factor: corners, lanes
    struct vector *load;              // (n)
    struct net_load taken_off[LANES]; // of the loads
    double largest_load[LANES];       // up to and with each
    double *applied;                  // (n * GRAIN) loads
    double *left;         // (n * GRAIN) to begin with, by the law of the factor; then
                          // what is left, and what joints do to held grains
    double *moved, *step; // (n * GRAIN)
    struct displacement *from;        // (n) the last equilibrium when all began
    double (*strain)[STRAINS];        // (n_joint) there
    struct lane_sums sums;            // where they moved
    uint8_t *touches_now;             // (n_joint) a bit a lane
    int *in_order;                    // (n_joint) joints, as the factor has them
    int n_row, row_capacity, n_given; // rows whose strains are given
    struct lane_row *row;
    bool *touches;        // (row_capacity * LANES)
    double *given, *more; // (row_capacity * LANES)
    struct settler *settler;
};

// What is left where the grains have MOVED, in LEFT, and the SUMS.
void find_left_lanes(struct equilibrium *equilibrium);

// The next loads, from the last equilibrium on. Then lanes from FIRST to END - 1 are
// looked at: where those end that were found. One round more for what rounding left.
void begin_lanes_anew(struct equilibrium *equilibrium);
int look(struct equilibrium *equilibrium, int first, int end);
void polish(struct equilibrium *equilibrium, int first, int end);

#endif
