// SPDX-License-Identifier: GPL-3.0-or-later
// Marks of the walls at a surface where the body ends at removed cells, or at
// auxiliary grains, instead of at walls [K 3.3.5, 3.7].
#pragma once

#include "network/network.h"

// Faces between grains that STAY (n_particle) and a cell beyond face one wall: of those
// that cut that cell, the one most nearly along the sum of their area vectors. Their
// nodes get the bit of that wall. In a LAYER the walls y do not count. Trap: these
// nodes have the bit of a wall that they do not lie on.
void face_walls(struct network *network, const bool *stay, bool layer);

// If there are auxiliary grains, throats with no other grain beside them get the kind
// THROAT_BOUNDARY_LAYER, and the nodes of the grains below get the bit of their wall.
void mark_boundary_layer(struct network *network, bool layer);
