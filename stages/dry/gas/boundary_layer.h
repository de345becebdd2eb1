// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary layer above the open surface, as a network of its own [K 3.3.5, 3.7]:
// nodes of the surface are extended into the gas by straight columns, level by level up
// to the drying air, and neighbouring columns exchange vapour sideways.
//
// Exchange areas (K Fig. 3.44) are those of a finite-volume scheme: seen along the
// columns, each has the part of the open surface that is nearest to it, and two that
// share an edge exchange through it, square to the line between them. The areas sum to
// the face whatever the network; on the cubic lattice they are K's L^2, and half of it
// for links along the surface.
#pragma once

#include "basics/status.h"
#include "network/network.h"

#include <stdint.h>

// Which nodes of the network stand below a column. K has both [K 3.3.5].
enum boundary_feet {
    FEET_SURFACE,  // all that lie on the open wall or, where cut cells are left out,
                   // face it
    FEET_AUXILIARY // those where a throat of kind THROAT_BOUNDARY_LAYER begins
};

struct boundary_form {
    enum boundary_feet feet;
    int layers;  // 0: as many as bring their spacing nearest to the unit of length
    bool lumped; // no lattice: each node exchanges with the air through its own area
};

// In units of the length given to boundary_layer_init.
struct boundary_layer {
    int layers;     // from the surface, level 0, to the drying air, level LAYERS
    double spacing; // between levels

    int n_exposed;
    int *exposed;  // (n_exposed) nodes of the network with a column, ascending on each
                   // wall; on the edge of two walls one for each
    uint8_t *wall; // (n_exposed) 0..5
    double *area; // (n_exposed) exchange area; they sum to the area of the open surface

    int n_lateral;
    int (*lateral)[2]; // (n_lateral) links along a level, as indices into exposed
    double *lateral_conductance; // (n_lateral) area over length; half of it at level 0
    double *lateral_width;       // (n_lateral) of the area
    double *lateral_length;      // (n_lateral)
    double (
        *lateral_edge)[4]; // (n_lateral) seen along the columns, from where to where
                           // the area reaches, along the axes that follow the open
};

// FOOT (n_node) becomes true for the nodes that have a column if none lies before them.
void boundary_feet_mark(const struct network *network, int wall,
                        enum boundary_feet feet, bool *foot);

// Only nodes with a throat of kind THROAT_NETWORK have columns; of several that lie one
// behind the other, the outermost. The open surface is the rectangle that these throats
// span: the wall itself, where cells are cut by it. It repeats where the box does;
// along an axis without extent it is as wide as the box (a layer of grains). THICKNESS
// is in units of LENGTH (m).
//
// STATUS_BAD_DATA: no node for a column; a wall that is not there because the box
// repeats; too many levels to number. The caller frees LAYER with boundary_layer_free,
// also after a failure. About O(exposed nodes) where they are spread evenly. A wet
// surface evaporates its area over the thickness.
enum status boundary_layer_init(const struct network *network, int wall, double length,
                                double thickness, const struct boundary_form *form,
                                struct boundary_layer *layer, struct reason *reason);

// The same on all WALLS (bits of enum wall) that are open, as one. Those of two walls
// are not joined around the edge.
enum status boundary_layers_init(const struct network *network, unsigned walls,
                                 double length, double thickness,
                                 const struct boundary_form *form,
                                 struct boundary_layer *layer, struct reason *reason);

void boundary_layer_free(struct boundary_layer *layer);
