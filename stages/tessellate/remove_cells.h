// SPDX-License-Identifier: GPL-3.0-or-later
// Removal of cells from a complete network, and its reduction to a plane.
#pragma once

#include "network/network.h"

// Elimination strategy [K 3.3.3, 3.7]: takes from a network truncated to its box the
// cells that the box cuts, and what belongs to no other cell: faces, throats and nodes.
// A cell is cut when it has a face on a wall, be it unbounded or only larger than the
// box. The cells that stay are whole; all grains stay in the packing, for those taken
// away are beside the outer throats. Auxiliary grains do not stay, but throats of the
// boundary layer that begin at what stays do. Nodes at cut cells face the walls that
// cut them. In a layer of grains the walls y do not count. Returns how many cells stay.
int eliminate_cut_cells(struct network *network, bool layer);

// The network of a layer of grains, all with their centres in one plane y [K 3.3.6]:
// what lies in the lower wall y. Layers repeat along y at the thickness of the box, and
// the plane half way between two is that wall, so that grains and throats are staggered
// and throats measure their clearance to grains half a thickness away. Faces are the
// cells, each with that wall as its second side.
void reduce_to_plane(struct network *network);

// Removes the nodes whose NUMBER (n_node) is negative; for the others NUMBER becomes
// the new index.
void compact_nodes(struct network *network, int *number);
