// SPDX-License-Identifier: GPL-3.0-or-later
// Auxiliary grains give the boundary layer its nodes and are not there: they go.
#ifndef CRAQUELURE_AUXILIARY_H
#define CRAQUELURE_AUXILIARY_H

#include "geometry/packing.h"
#include "protocol.h"

// Takes them, their bonds and the forces on them out of PACKING and PROTOCOL.
void drop_auxiliary(struct packing *packing, struct protocol *protocol);

#endif
