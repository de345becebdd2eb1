// SPDX-License-Identifier: GPL-3.0-or-later
// Liquid that throats imposed empty, or closed, have shut in: no gas can reach it.
#pragma once

#include "network/network.h"

// Imposes empty as well the throats of NETWORK from which no way through liquid leads
// to a node of OPEN (n_node); none where there is no such node. Returns how many.
int empty_enclosed_throats(struct network *network, const bool *open);

// The same, with the nodes on OPEN_WALLS (a bit each) open.
int empty_throats_cut_off(struct network *network, unsigned open_walls);
