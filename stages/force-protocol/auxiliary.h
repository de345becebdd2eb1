// SPDX-License-Identifier: GPL-3.0-or-later
// Auxiliary grains only give the boundary layer its nodes: they are removed at the
// end.
#ifndef CRAQUELURE_AUXILIARY_H
#define CRAQUELURE_AUXILIARY_H

#include "geometry/packing.h"
#include "protocol.h"

// Removes auxiliary grains, their bonds and the forces on them from PACKING and
// PROTOCOL, in place; the others keep their order.
void drop_auxiliary(struct packing *packing, struct protocol *protocol);

#endif
