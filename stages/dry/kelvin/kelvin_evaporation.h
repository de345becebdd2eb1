// SPDX-License-Identifier: GPL-3.0-or-later
// What bodies of liquid evaporate at given potentials, and the rounding of it.
// Evaporation is a sum of conductances times differences of potential, in which large
// terms of both signs may cancel: so its rounding is found along with it.
#pragma once

#include "kelvin_menisci.h"

// Sets kelvin->evaporation of each body and kelvin->rate into the air, both scaled,
// from kelvin->potential. Below 0 where vapour condenses. O(links of the wet nodes).
void kelvin_find_evaporation(struct kelvin_menisci *kelvin,
                             const struct occupancy *occupancy);

// Sets kelvin->conductance_bound of each body from those of its nodes.
void kelvin_find_conductance_bounds(struct kelvin_menisci *kelvin,
                                    const struct occupancy *occupancy);

// Sets kelvin->noise of each body: evaporation below it is rounding.
void kelvin_find_noise(struct kelvin_menisci *kelvin);
