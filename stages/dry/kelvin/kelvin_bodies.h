// SPDX-License-Identifier: GPL-3.0-or-later
// The bodies of liquid beside gas, and the share of each in the wet nodes. A body is a
// cluster, or in immobile liquid a throat: what has one pressure, and so one vapour
// pressure at its menisci.
#pragma once

#include "kelvin_menisci.h"

// Lists the bodies and their shares for the OCCUPANCY of now. O(throats at wet nodes).
// Places of bodies are valid until the next listing.
void kelvin_list_bodies(struct kelvin_menisci *kelvin, struct occupancy *occupancy);

// What gravity adds to the potential at each wet node, for the exponents of the bodies.
// Scaled, as the vapour's potential is.
void kelvin_find_gravity_potentials(struct kelvin_menisci *kelvin,
                                    const struct occupancy *occupancy);

// Whether the throat where gas enters the body at PLACE is full, to rounding.
bool kelvin_is_full(const struct kelvin_menisci *kelvin,
                    const struct occupancy *occupancy, int place);
