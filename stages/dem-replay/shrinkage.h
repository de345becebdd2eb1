// SPDX-License-Identifier: GPL-3.0-or-later
// Drying shrinkage: by which linear strain each grain, with its bonds, has become
// smaller at each step of the load (dem/shrinkage.c has what it does).
#ifndef CRAQUELURE_DEM_REPLAY_SHRINKAGE_H
#define CRAQUELURE_DEM_REPLAY_SHRINKAGE_H

#include "geometry/packing.h"

enum shrinkage_law {
    SHRINKAGE_UNIFORM, // everywhere as the body loses its liquid
    SHRINKAGE_FRONT,   // behind a front that comes from the top
    SHRINKAGE_LIQUID   // as the throats around the grain lose theirs
};

// How grains shrink. It owns nothing.
struct shrinkage {
    enum shrinkage_law law;
    double strain;         // of a dry grain; 0: nothing shrinks
    double front_width;    // in mean diameters; NAN: the height of the body
    const uint8_t *held;   // (n_particle) 1: the substrate, which does not shrink
    const double *dryness; // (n_time * n_particle) for SHRINKAGE_LIQUID
};

// Turns the LIQUID around each grain, kg, (N_TIME * N), into its dryness in [0,1], with
// the SATURATION (N_TIME) of the network for grains that never had any.
void liquid_to_dryness(double *liquid, const double *saturation, int n_time, int n);

// Writes the strain of each grain (n_particle) at row ROW of the load, where SATURATION
// of the network is left. Row -1 is before the load: nothing.
void find_shrinkage(const struct shrinkage *how, const struct packing *packing, int row,
                    double saturation, double *strain);

#endif
