// SPDX-License-Identifier: GPL-3.0-or-later
// Networks that come from elsewhere: what every reader of them checks and fills in.
#pragma once

#include "basics/status.h"
#include "network/network.h"

// Room for that many nodes and throats, zeroed, throat volumes included; no grains, no
// faces. The caller frees it with network_free.
struct network network_init(int n_node, int n_throat);

// Puts the lower node of each throat first. STATUS_BAD_DATA: nodes that are not there,
// both ends at one node, radii, lengths or volumes below 0, and what is not finite or
// beyond 1e150, the most that artifacts hold. Rows in REASON count from 0. In place;
// O(n_throat + n_node).
enum status check_network(struct network *network, struct reason *reason);

// The box around the nodes; where they all lie in one plane, as thick as throats are
// long.
void box_around_nodes(struct network *network);

// Marks in node_walls which walls of the box nodes lie on, to the last digit: those of
// box_around_nodes are node coordinates.
void find_walls(struct network *network);

// Frees throat_volume where all volumes are those of the cylinders to the last digit.
void drop_cylinder_volumes(struct network *network);
