// SPDX-License-Identifier: GPL-3.0-or-later
// The weight of the body: a load under which it is at rest before drying begins, and
// which stays on it while it dries.
#ifndef CRAQUELURE_DEM_REPLAY_WEIGHT_H
#define CRAQUELURE_DEM_REPLAY_WEIGHT_H

#include "geometry/bond_numbers.h"
#include "replay.h"

// What the weight is computed from. It owns nothing.
struct weighing {
    const struct packing *packing;
    double density;       // of the grains, kg/m3
    double gravity;       // towards -z, m/s2
    const double *liquid; // (n_particle) kg around each grain before drying; NULL: none
};

// Adds the weight of the grains to every row of LOAD, which has that of the liquid
// already. Returns what stands on the grains before drying begins (n_particle) N: their
// weight and that of their liquid; the caller frees it.
struct vector *add_weight(struct load *load, const struct weighing *of);

// With the forces of LOAD before any weight of grains was added, and the suction that
// they come from, Pa; 0: unknown.
struct bond_numbers find_bond_numbers(const struct load *load, double suction,
                                      const struct weighing *of);

#endif
