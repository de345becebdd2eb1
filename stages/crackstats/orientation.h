// SPDX-License-Identifier: GPL-3.0-or-later
// Directions of cracked bonds; the crack itself is perpendicular to its bond.
#pragma once

#include "run.h"

enum { INCLINATION_CLASSES = 9 }; // of ten degrees

// An empty one is {0}.
struct orientation {
    double bonds[INCLINATION_CLASSES];              // of all bonds, broken or not
    double cracks[INCLINATION_CLASSES][MODE_COUNT]; // of those that broke
    double fabric[MODE_COUNT][9]; // sum of n n over them, row by row; n: along the bond
};

// Adds the bonds of RUN, by their inclination to z from 0 to 90 degrees. Class 0 is
// upright, along z. Cracks between coincident grains have no direction and are left out
// (their bonds count as upright). O(bonds + cracks). n and -n are one direction.
void add_orientation(struct orientation *orientation, const struct run *run);
