// SPDX-License-Identifier: GPL-3.0-or-later
// How what menisci evaporate falls with their potentials: bounds, from the conductances
// of the vapour's links.
#ifndef CRAQUELURE_KELVIN_RESPONSE_H
#define CRAQUELURE_KELVIN_RESPONSE_H

#include "kelvin_viscous.h"

// Of the K-th meniscus at hand that flows.
int throat_of(const struct kelvin_viscous *coupling, int k);

// Fills LUMPED and SINGLE for the menisci as they are listed.
void find_response_bounds(struct kelvin_viscous *coupling,
                          const struct occupancy *occupancy);

// Of the flow, at the exponents of now: where liquid flows easily menisci rise and fall
// with their cluster, else alone.
void set_responses(struct kelvin_viscous *coupling, const struct occupancy *occupancy);

#endif
