// SPDX-License-Identifier: GPL-3.0-or-later
// From grains to their pore network: the edges of the diagram are the throats [K 3.3].
#pragma once

#include "basics/status.h"
#include "network/clearance.h"
#include "network/network.h"

#include <stdbool.h>

enum boundary {
    BOUNDARY_TRUNCATE, // the walls cut the cells [K 3.3.1]
    BOUNDARY_ELIMINATE // cells that walls would cut are left out [K 3.3.3, 3.7]
};

struct tessellation {
    bool power; // power diagram (K's Dirichlet); else Voronoi
    enum clearance clearance;
    enum boundary boundary;
    bool shapes; // throats conduct as the void between their grains; else as cylinders
    bool entry;  // radii are those at which gas enters, for the contact angle
    double contact_angle; // rad
    bool layer;           // the network of one layer of grains, in a plane [K 3.3.6]
};

// What the network left out or had to decide.
struct tessellation_report {
    int hidden;   // grains without a cell of their own (power diagrams)
    int n_closed; // throats without clearance; below 0 is taken as 0
    int n_cell;   // cells in the network
};

// The network of PACKING in its box, cut by its bodies. On success *NETWORK is the
// caller's; the packing is copied into it. STATUS_BAD_DATA: no grains, a grain outside
// the box, two grains at one place, a box that repeats and is too narrow, or no cell
// left.
//
// Nodes come in the order of the grains they lie between, so that their order says
// where they are, not how the triangulation was built. Wall nodes that coincide (an
// image plane makes every one degenerate) are one node; inside, nothing is merged: four
// throats a node.
enum status tessellate(const struct packing *packing, const struct tessellation *how,
                       struct network *network, struct tessellation_report *report,
                       struct reason *reason);
