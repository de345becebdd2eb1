// SPDX-License-Identifier: GPL-3.0-or-later
// Loads that lie on lines between a few of them, as forces do that are interpolated
// between events of drying: what is linear in the load needs the corners only.
#ifndef CRAQUELURE_LOAD_PATH_H
#define CRAQUELURE_LOAD_PATH_H

#include "geometry/vector.h"
#include "sparse/supernodal.h"

enum { ON_PATH = 64 }; // loads, at most

// Of the first COUNT loads each lies, to rounding, SHARE of the way from the corner
// AFTER to the next one; there are as many corners as lanes, or fewer.
struct load_path {
    int count, corners, corner[LANES]; // loads
    int after[ON_PATH];
    double share[ON_PATH];
};

// Of COUNT loads FORCE (count * n) as many as there are.
void find_load_path(struct load_path *path, int n, int count,
                    const struct vector *force);

// What lane L of the loads from FIRST to FIRST + LANES - 1 has of each corner:
// SHARE (corners * LANES), 0 beyond the last.
void path_shares(const struct load_path *path, int first, double share[LANES][LANES]);

#endif
