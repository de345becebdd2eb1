// SPDX-License-Identifier: GPL-3.0-or-later
// The weight of the body: a load under which it is at rest before drying begins, and
// which stays on it while it dries.
#pragma once

#include "geometry/bond_numbers.h"
#include "replay.h"

// What the weight is computed from. It owns nothing.
struct weighing {
    const struct packing *packing;
    double density;       // of the grains, kg/m3
    double gravity;       // towards -z, m/s2
    const double *liquid; // (n_particle) kg around each grain before drying; NULL: none
};

// The weight of each grain (n_particle) N. The caller frees it. density gravity (4/3)
// pi R^3; >= 0.
double *grain_weights(const struct weighing *of);

// What stands on the grains before drying begins (n_particle) N: their weight and that
// of their liquid. The caller frees it.
struct vector *standing_weight(const struct weighing *of);

// With the LARGEST force (N) on a grain at any time, without any weight of grains; 0:
// there is none; and the SUCTION that forces come from, Pa; 0: unknown. Of a grain:
// mean weight over LARGEST. Of the body: what stands on its base, per area, over
// SUCTION.
struct bond_numbers find_bond_numbers(double largest, double suction,
                                      const struct weighing *of);
