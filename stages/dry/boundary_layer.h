// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary layer above the open wall, as a network of its own [K 3.3.5]: the
// exposed nodes of the surface are extended into the gas, layer by layer up to the
// drying air.
//
// Exchange areas are those of a finite-volume scheme whose cells stand on the wall's
// faces. A face is the wall's part of a grain's cell; seen from the foot of the grain's
// centre it falls into triangles, half of each belonging to either end of its edge.
// Each node's area is what the faces around it give it; two nodes at the ends of an
// edge exchange through the width between the feet on both sides of it. On the square
// faces of the cubic lattice this is K's A = L^2, and half of it for lateral links
// along the surface. Above a layer of grains the cells stand on the throats in the
// wall, as wide as the layer is thick.
#ifndef CRAQUELURE_BOUNDARY_LAYER_H
#define CRAQUELURE_BOUNDARY_LAYER_H

#include "basics/status.h"
#include "network/network.h"

// In units of the length given to boundary_layer_make.
struct boundary_layer {
    int layers;     // from the surface, level 0, to the drying air, level LAYERS
    double spacing; // between levels

    int n_exposed;
    int *exposed; // (n_exposed) nodes of the network, ascending
    double *area; // (n_exposed) exchange area; they sum to the area of the wall

    int n_lateral;
    int (*lateral)[2]; // (n_lateral) links along a level, as indices into exposed
    double *lateral_conductance; // (n_lateral) area over length; half of it at level 0
};

// Exposed are the nodes on WALL (0..5) with a throat of kind THROAT_NETWORK. Area that
// belongs to other nodes of a face is shared among its exposed ones in proportion to
// their own; that of faces without any, among all. THICKNESS is in units of LENGTH (m).
// LAYERS = 0 takes the number that brings the spacing nearest to LENGTH.
//
// STATUS_BAD_DATA: no exposed node; no face (of a layer: throat) on the wall; a wall
// that is not there because the box repeats; exposed nodes one on the other; too many
// levels to number. The caller frees LAYER with boundary_layer_free, also after a
// failure.
enum status boundary_layer_make(const struct network *network, int wall, double length,
                                double thickness, int layers,
                                struct boundary_layer *layer, struct reason *reason);

void boundary_layer_free(struct boundary_layer *layer);

#endif
