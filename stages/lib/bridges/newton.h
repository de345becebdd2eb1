// SPDX-License-Identifier: GPL-3.0-or-later
// The four equations of a bridge and Newton's method on them; for equilibrium.c only.
#pragma once

#include "bridges/meridian.h"

#include <stdbool.h>

// Newton's method on four unknowns: the logarithms of both reaches and of the length,
// and the turn. Two of the four equations are always the same (slope and radius at the
// second body). The third gives the volume, or the mean curvature that a suction asks
// for; the fourth gives the gap, or how far to go along a direction from a known
// bridge. At rupture two bridges of one gap meet: there the
// first is singular, the second is not.
struct unknowns {
    double at[ARC_NUMBERS];
};

// In effective radii. It owns nothing.
struct problem {
    const struct bodies *bodies;
    double volume;           // of the liquid
    const double *curvature; // NULL: the volume is given; else H takes its place
    double shared;           // by overlapping bodies: the arc spans so much less
    double gap;
    bool symmetric;  // of two equal bodies only bridges with equal ends are looked for
    bool to_turning; // the break of symmetry does not count
    const struct unknowns *from; // NULL: the gap is given
    const double *direction;     // of length 1
    double distance;
};

#define RESIDUAL_ROUNDING 1e-9 // residuals below may be rounding alone

// Residuals of the equations and their derivatives. SLOPE[i][j] is the derivative of
// residual i by unknown j; WAIST_SLOPE that of the neck.
struct system {
    double residual[ARC_NUMBERS], slope[ARC_NUMBERS][ARC_NUMBERS];
    double waist_slope[ARC_NUMBERS];
};

// The equations of PROBLEM at UNKNOWNS.
struct system system_at(const struct problem *problem, const struct unknowns *unknowns);

// Gauss' elimination: RIGHT becomes the solution. Returns the determinant; 0: singular.
// MATRIX is overwritten.
double eliminate(double matrix[ARC_NUMBERS][ARC_NUMBERS], double right[ARC_NUMBERS]);

// FROM + SHARE times STEP.
struct unknowns moved(const struct unknowns *from, const double step[ARC_NUMBERS],
                      double share);

// Whether these unknowns describe an arc: each contact line on its body, turn below 2
// pi.
bool sensible(const struct bodies *bodies, const struct unknowns *unknowns);

// Newton's method, damped. Returns whether it converged; adds the number of its steps
// to COUNT. Steps are shortened until the residual falls and the unknowns are sensible.
bool converge(const struct problem *problem, struct unknowns *unknowns, int *count);

// The arc that these unknowns stand for; and back.
struct arc arc_of(const struct unknowns *unknowns);
struct unknowns unknowns_of(const struct arc *arc);
