// SPDX-License-Identifier: GPL-3.0-or-later
// Drying shrinkage: by which linear strain each grain, with its bonds, has become
// smaller at each step of the load (dem/shrinkage.c has what it does).
//
// With t = 1 - saturation, w the dryness, b the width of the front over the height h of
// the body, and m the mass of liquid around a grain, strain = shrinkage.strain w:
//     uniform   w = t
//     front     w = ((1 + b) t - (z_top - z) / h) / b, cut off at 0 and 1
//     liquid    w = 1 - m / m_most
#pragma once

#include "geometry/packing.h"

enum shrinkage_law {
    SHRINKAGE_UNIFORM, // everywhere as the body loses its liquid
    SHRINKAGE_FRONT,   // behind a front that comes from the top
    SHRINKAGE_LIQUID   // as the throats around the grain lose theirs
};

// How grains shrink. It owns nothing.
struct shrinkage {
    enum shrinkage_law law;
    double strain;       // of a dry grain; 0: nothing shrinks
    double front_width;  // in mean diameters; NAN: the height of the body
    const uint8_t *held; // (n_particle) 1: the substrate, which does not shrink
};

// DRYNESS (N) in [0,1] of grains with LIQUID (N) around them, kg, of the MOST (N) that
// they ever have; with the SATURATION of the network for grains that never have any.
void liquid_to_dryness(const double *liquid, const double *most, double saturation,
                       int n, double *dryness);

// Writes the strain of each grain (n_particle) at row ROW of the load, where SATURATION
// of the network is left, and where grains have this DRYNESS (n_particle), which
// SHRINKAGE_LIQUID goes by. Row -1 is before the load: nothing.
void find_shrinkage(const struct shrinkage *how, const struct packing *packing, int row,
                    double saturation, const double *dryness, double *strain);
