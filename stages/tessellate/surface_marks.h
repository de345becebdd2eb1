// SPDX-License-Identifier: GPL-3.0-or-later
// Where the body ends at cells that are cut by the box and left out, or at auxiliary
// grains, instead of at walls [K 3.3.5, 3.7].
#ifndef CRAQUELURE_SURFACE_H
#define CRAQUELURE_SURFACE_H

#include "network/network.h"

// What lies between grains that STAY and a cell beyond faces one wall: of those that
// cut that cell, the one that its faces together look at best. Their nodes belong to
// that wall from now on. In a LAYER the walls y do not count.
void face_walls(struct network *network, const bool *stay, bool layer);

// Where there are auxiliary grains, throats with no other grain beside them become
// throats of the boundary layer, and the nodes of what stays below face their wall.
void mark_boundary_layer(struct network *network, bool layer);

#endif
