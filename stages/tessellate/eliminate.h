// SPDX-License-Identifier: GPL-3.0-or-later
// Elimination strategy [K 3.3.3, 3.7]: cells that are not bounded by grains alone go.
#ifndef CRAQUELURE_ELIMINATE_H
#define CRAQUELURE_ELIMINATE_H

#include "network/network.h"

// Takes from a network truncated to its box the cells that the box cuts, and what
// belongs to no other cell: faces, throats and nodes. A cell is cut when it has a face
// on a wall, be it unbounded or only larger than the box. The cells that stay are
// whole; all grains stay in the packing, for those taken away are beside the outer
// throats. Returns how many cells stay.
int eliminate_cut_cells(struct network *network);

#endif
