// SPDX-License-Identifier: GPL-3.0-or-later
// Networks that come from elsewhere: what every reader of them checks and fills in.
#ifndef CRAQUELURE_FOREIGN_H
#define CRAQUELURE_FOREIGN_H

#include "basics/status.h"
#include "network/network.h"

// Room for that many nodes and throats; no grains, no faces. The caller frees it.
struct network new_network(int n_node, int n_throat);

// Lower node first; refuses nodes that are not there, both ends at one, radii, lengths
// and volumes below 0, and what is not finite. Rows count from 0.
enum status check_network(struct network *network, struct reason *reason);

// The box around the nodes; where they all lie in one plane, as thick as throats are
// long.
void box_around_nodes(struct network *network);

// Which walls of the box nodes lie on, to the last digit.
void find_walls(struct network *network);

// Volumes that are those of the cylinders to the last digit need not be said.
void drop_cylinder_volumes(struct network *network);

#endif
