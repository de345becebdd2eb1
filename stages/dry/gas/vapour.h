// SPDX-License-Identifier: GPL-3.0-or-later
// Quasi-steady vapour transport [K 3.9] through the empty throats and the boundary
// layer.
//
// With the potential ln(1 - p_v/p_g), K 3.9 is linear: a network of conductances, with
// the potential scaled to 0 where the vapour is saturated and 1 in the drying air. Only
// what wet nodes give off matters, so nodes of the gas are eliminated as they dry: what
// is left links wet nodes with each other, through which nothing flows since all are at
// 0, and with the air, at 1. What a wet node evaporates is its conductance to the air.
#ifndef CRAQUELURE_VAPOUR_H
#define CRAQUELURE_VAPOUR_H

#include "basics/compensated.h"
#include "boundary_layer.h"
#include "elimination/kron_fronts.h"

struct vapour {
    // Sites are the network's nodes, then the boundary layer's nodes level by level.
    int n_site;
    double *conductance; // (n_throat) area over length
    struct kron_fronts mesh;
};

// For a network that is full of liquid, under LAYER; with a TOLERANCE above 0 links on
// large fronts are floats. Lengths are in units of LENGTH (m), conductances area over
// length in the same. Where molecules meet the wall of a throat as often as each other,
// at KNUDSEN_RADIUS (m), the diffusivity is halved; 0: nowhere.
struct vapour vapour_make(const struct network *network, double length,
                          double knudsen_radius, const struct boundary_layer *layer,
                          double tolerance);

// THROAT, from node A to node B, has emptied. NODE has gas and no liquid beside it any
// more.
void vapour_open_throat(struct vapour *vapour, int throat, int a, int b);
void vapour_dry_node(struct vapour *vapour, int node);

// Into the drying air.
double vapour_rate(const struct vapour *vapour);

// What a wet node gives off. Exactly 0 if no way leads from it to the drying air.
double vapour_evaporation(const struct vapour *vapour, int node);

void vapour_free(struct vapour *vapour);

#endif
