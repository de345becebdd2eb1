// SPDX-License-Identifier: GPL-3.0-or-later
// The shear band of a split-bottom cell: its centre and width at each height.
#pragma once

#include "band_fit.h"
#include "grid.h"

// The cell, as the user says it. HEIGHT is not owned. RATE has the sign of the turning
// about the axis of the frame.
struct split_cell {
    double rate;         // angular velocity of the turning part, 1/s
    bool inner_turns;    // else the outer part
    double inner, outer; // radii between which profiles are fitted, m
    int n_level;
    const double *height;  // (n_level) rising, m
    double least_fraction; // of solid, for a cell to count
};

// The profile at HEIGHT between the two nearest layers of cells: TURNED (n_r) is the
// angular velocity over that of the turning part, where COUNTS (n_r) is 1. SUM is over
// SNAPSHOTS snapshots. GRID is cylindrical; SUM (n_cell, SUM_ALL) has the columns of
// sums.h. Where COUNTS is 0 (outside of inner to outer, too little solid, no mass)
// TURNED has no meaning.
void level_profile(const struct grid *grid, const double *sum, int snapshots,
                   const struct split_cell *cell, double height, double *turned,
                   bool *counts);

// Fits at all levels; FIT (n_level). SMOOTHING as for fit_band. A level that has no fit
// is there, not converged.
void fit_levels(const struct grid *grid, const double *sum, int snapshots,
                const struct split_cell *cell, double smoothing, struct band_fit *fit);

// Centre and width at HEIGHT, linear between the levels that have a fit and constant
// beyond; false where none has. Levels without a fit are passed over: the line goes
// between their neighbours.
bool band_at(const struct split_cell *cell, const struct band_fit *fit, double height,
             double *centre, double *width);
