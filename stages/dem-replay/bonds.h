// SPDX-License-Identifier: GPL-3.0-or-later
// Which grains are bonded, and how strongly each bond.
#ifndef CRAQUELURE_BONDS_H
#define CRAQUELURE_BONDS_H

#include "geometry/packing.h"

enum bonds_by {
    BONDS_BY_PACKING,  // those listed in it
    BONDS_BY_TOUCHING, // grains that touch, to rounding
    BONDS_BY_DISTANCE, // grains whose surfaces are a GAP apart or less
    BONDS_BY_NONE
};

// Gives PACKING its bonds, sorted by their two grains; across the sides too where the
// box repeats. GAP is over the sum of the two radii.
void bond_grains(struct packing *packing, enum bonds_by by, double gap);

enum strength_law {
    STRENGTH_ONE,    // all bonds have the mean
    STRENGTH_NORMAL, // cut off at 0: no strength below it is drawn
    STRENGTH_WEIBULL // of two parameters
};

struct strength_scatter {
    enum strength_law law;
    double variation; // normal: standard deviation over mean, before the cut; >= 0
    double modulus;   // Weibull: m > 0; the scale is 1 / Gamma(1 + 1/m), of mean 1
    int64_t seed;
};

// N strengths over the mean, that the caller frees; NULL where all are the mean. One
// random number each (GSL's mt19937): the same seed gives the same, which a larger mean
// only scales, and the first of more.
double *draw_strengths(const struct strength_scatter *scatter, int n);

// (n_bond) Of the bonds of PACKING: drawn in the order of the places of their middles,
// from above, then along x, then y, and so whatever the grains are numbered like.
// Places count as equal that differ by less than about 1e-9 of the extent of the
// grains; of bonds that cross in the middle the steeper ones come first. As
// draw_strengths.
double *bond_strengths(const struct strength_scatter *scatter,
                       const struct packing *packing);

#endif
