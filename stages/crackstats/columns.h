// SPDX-License-Identifier: GPL-3.0-or-later
// The damage of a layer seen from above, in upright columns half a mean diameter wide,
// or nearly so, as whole ones fill the box (docs/craquelure.md). The map lies in x and
// y, and z is up; all is measured before anything has moved.
#pragma once

#include "run.h"

#include <stdbool.h>

// Columns side by side, the one (x, y) at x + count[0] y. Lengths in m. Where no grain
// is held, `floor` is the lowest surface of a grain.
struct columns {
    int count[2], n;   // along x and y; of all
    double edge[2];    // of one
    double lower[2];   // corner of the first
    bool periodic[2];  // whether they repeat
    double diameter;   // mean, of the grains
    double floor, top; // highest centre of a held grain; highest surface of any
    double height;     // of the layer, by surfaces
};

// The column that a point lies in, on the border of two, to rounding, the upper one;
// one outside of the box counts with the nearest.
int column_at(const struct columns *columns, double x, double y);

// The neighbour of COLUMN by DX, DY columns, or -1 outside of the box.
int column_beside(const struct columns *columns, int column, int dx, int dy);

// The columns over the box of RUN, which needs a grain. It owns nothing.
struct columns columns_init(const struct run *run);

// A bond is lateral if neither of its grains is held. All are, where `held` is not
// known.
bool is_lateral(const struct run *run, int bond);

// The column of the middle of BOND, and its horizontal length, m.
int column_of_bond(const struct columns *columns, const struct run *run, int bond,
                   double *length);

// Share of the lateral bonds that are not INTACT (n_bond) in each column: each bond
// weighs its horizontal length and counts at its middle; broken and all are smoothed by
// a Gaussian of 0.8 diameters before they are divided. 0 where there are no bonds. The
// caller frees it.
double *column_damage(const struct columns *columns, const struct run *run,
                      const uint8_t *intact);
