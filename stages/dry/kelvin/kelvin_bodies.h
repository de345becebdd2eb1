// SPDX-License-Identifier: GPL-3.0-or-later
// Which bodies of liquid are beside gas, and what each has of the wet nodes.
#ifndef CRAQUELURE_KELVIN_BODIES_H
#define CRAQUELURE_KELVIN_BODIES_H

#include "kelvin_menisci.h"

// Lists them, and their shares, as OCCUPANCY are now.
void kelvin_list_bodies(struct kelvin_menisci *kelvin, struct occupancy *occupancy);

// What gravity adds to the potential at each wet node, as curved as the bodies are.
void kelvin_find_gravity_potentials(struct kelvin_menisci *kelvin,
                                    const struct occupancy *occupancy);

// Whether the throat that gas enters the body at PLACE by is full.
bool kelvin_is_full(const struct kelvin_menisci *kelvin,
                    const struct occupancy *occupancy, int place);

#endif
