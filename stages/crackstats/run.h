// SPDX-License-Identifier: GPL-3.0-or-later
// One run, as read from its response artifact; read.h says what has been checked.
#pragma once

#include "geometry/packing.h"

enum { MODE_NORMAL, MODE_SHEAR, MODE_COUNT };

// It owns all arrays. Lengths in m, in the packing before anything has moved.
struct run {
    struct packing packing;
    int n_crack;
    int32_t *bond;                // (n_crack) row of packing.bond, each at most once
    double *time;                 // (n_crack) s, nondecreasing
    double *saturation;           // (n_crack) of the network at that time
    uint8_t *mode;                // (n_crack) 0 normal, 1 shear
    int n_before;                 // broken in earlier replays and under the weight
    int32_t *before;              // (n_before) bonds, each once
    uint8_t *held;                // (n_particle) 1: held; NULL: not known
    double first_period_end, end; // s; end: of the last load
    int n_unsettled;              // loads that did not come to rest
    int n_unsettled_crack;        // cracks that opened under them
    int n_snapshot;
    double *snapshot_saturation; // (n_snapshot) of the network
    struct vector *displacement; // (n_snapshot, n_particle) m, since the start
    double *dryness; // (n_snapshot, n_particle) share of the pores around each grain
                     // that hold gas; NULL: not known
    uint8_t *intact; // (n_snapshot, n_bond) 1: holds
};

// The periodic image of the second grain of BOND that is nearest to the first, by the
// places in PACKING, those before drying. 0 along an axis that does not repeat. O(1).
struct image bond_image(const struct packing *packing, int bond);

// The vector from the first grain of BOND to the second before anything has moved, m.
struct vector bond_vector(const struct packing *packing, int bond);

// 1 for each bond that holds when the run begins (bonds_before: all but those that
// earlier replays or the weight alone broke), or at the end (bonds_left: without those
// of the cracks as well). (n_bond); the caller frees it.
uint8_t *bonds_before(const struct run *run);
uint8_t *bonds_left(const struct run *run);

// Frees what the run owns and empties it.
void run_free(struct run *run);
