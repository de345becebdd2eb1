// SPDX-License-Identifier: GPL-3.0-or-later
// Which grains are bonded, and the strength of each bond.
#pragma once

#include "geometry/packing.h"

enum bonds_by {
    BONDS_BY_PACKING,  // those listed in it
    BONDS_BY_TOUCHING, // grains that touch, to rounding
    BONDS_BY_DISTANCE, // grains whose surfaces are a GAP apart or less
    BONDS_BY_NONE
};

// Gives PACKING its bonds, sorted by their two grains; in a periodic box across its
// sides as well. GAP is over the sum of the two radii.
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

// N strengths over the mean, which the caller frees; NULL if all are the mean. One
// random number each (GSL's mt19937): the same seed gives the same strengths, and more
// bonds only add to them.
double *draw_strengths(const struct strength_scatter *scatter, int n);

// The strengths (n_bond) of the bonds of PACKING over the mean: its own, times those
// drawn in the order of the places of their middles, from above, then along x, then y:
// so they do not depend on how grains are numbered. Places that differ by less than
// about 1e-9 of the extent of the grains count as equal; of bonds that cross in the
// middle the steeper one comes first. Ownership as draw_strengths.
double *bond_strengths(const struct strength_scatter *scatter,
                       const struct packing *packing);

// N times 1, which the caller frees.
double *equal_strengths(int n);
