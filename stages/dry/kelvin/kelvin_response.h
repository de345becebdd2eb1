// SPDX-License-Identifier: GPL-3.0-or-later
// How what menisci evaporate decreases with their potentials: bounds, from the
// conductances of the vapour's links, and the response of the flow made of them.
#pragma once

#include "kelvin_viscous.h"

// The throat of the K-th of the coupling's menisci.
int throat_of(const struct kelvin_viscous *coupling, int k);

// Sets coupling->lumped and coupling->single for the menisci that are listed.
void find_response_bounds(struct kelvin_viscous *coupling,
                          const struct occupancy *occupancy);

// Sets flow->response at the present exponents: where liquid flows easily, menisci
// change together with their cluster, else alone. An estimate: it sets how fast the
// fixed point converges, not where to.
void set_responses(struct kelvin_viscous *coupling, const struct occupancy *occupancy);
