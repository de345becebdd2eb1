// SPDX-License-Identifier: GPL-3.0-or-later
// The weight of the liquid, on the grains around it.
#pragma once

#include "liquid_loads.h"
#include "solid_angle_patches.h"

// The share of each grain in the liquid of a throat, as a pull towards -z; those of one
// throat sum to 1. In proportion to the void of its cell beside the throat, as in
// find_void_volumes, so that a grain carries the liquid in its own cell; in equal parts
// in layers and where there is no void. The caller frees it.
struct patches find_liquid_shares(struct sectors *sectors);

// Of the liquid, kg/m3, from the MASS with which the drying began and the volume of
// throats and rings that it filled then.
double liquid_density(const struct network *network, const struct liquid_record *record,
                      double mass);

// MASS (n_particle) becomes that of the liquid around each grain now, kg, by its
// SHARES. With GRAVITY > 0, that of the law.
void liquid_masses(const struct liquid_loads *liquid, const struct patches *shares,
                   double gravity, double *mass);
