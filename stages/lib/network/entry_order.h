// SPDX-License-Identifier: GPL-3.0-or-later
// The order in which gas enters throats, or nodes, that it could enter: the easiest
// first. Throats that share their narrowest place have equal radii, so which of them is
// first must not depend on how the network is numbered.
#pragma once

#include "network/network.h"

// ORDER (n_throat): throats by falling ENTRY_PRIORITY (n_throat; NULL: by radius). Of
// those that are equal to 12 digits first the shorter, then that which holds less, then
// that whose middle is higher (as any gravity would have it), lower along x, lower
// along y; at last that with the lowest number, which tells apart only throats that lie
// in each other. Lengths and places count as equal that differ by less than about 1e-9
// of the network's extent, volumes by as much of the largest. All throats are in ORDER,
// those of other kinds, too.
void order_throats(const struct network *network, const double *entry_priority,
                   int *order);

// The same for nodes, by falling ENTRY_PRIORITY (n_node); of equals the higher, and so
// on.
void order_nodes(const struct network *network, const double *entry_priority,
                 int *order);
