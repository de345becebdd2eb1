// SPDX-License-Identifier: GPL-3.0-or-later
// What bodies of liquid evaporate at given potentials, and how well that is known.
#ifndef CRAQUELURE_KELVIN_EVAPORATION_H
#define CRAQUELURE_KELVIN_EVAPORATION_H

#include "kelvin_menisci.h"

// Finds EVAPORATION of each body, and RATE into the air, from POTENTIAL.
void kelvin_find_evaporation(struct kelvin_menisci *kelvin,
                             const struct occupancy *occupancy);

// Finds CONDUCTANCE_BOUND of each body from what its nodes conduct.
void kelvin_find_conductance_bounds(struct kelvin_menisci *kelvin,
                                    const struct occupancy *occupancy);

// Finds NOISE of each body: gains below it are rounding.
void kelvin_find_noise(struct kelvin_menisci *kelvin);

#endif
