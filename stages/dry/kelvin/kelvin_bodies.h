// SPDX-License-Identifier: GPL-3.0-or-later
// Which bodies of liquid are beside gas, and what each has of the wet nodes.
#ifndef CRAQUELURE_CURVED_BODIES_H
#define CRAQUELURE_CURVED_BODIES_H

#include "kelvin_menisci.h"

// Lists them, and their shares, as PHASES are now.
void curved_list_bodies(struct curved *curved, struct phases *phases);

// What gravity adds to the potential at each wet node, as curved as the bodies are.
void curved_raise_nodes(struct curved *curved, const struct phases *phases);

// Whether the throat that gas enters the body at PLACE by is full.
bool curved_is_full(const struct curved *curved, const struct phases *phases,
                    int place);

#endif
