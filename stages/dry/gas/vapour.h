// SPDX-License-Identifier: GPL-3.0-or-later
// Quasi-steady vapour transport [K 3.9] through the empty throats and the boundary
// layer.
//
// With the potential ln(1 - p_v/p_g), K 3.9 is linear: a network of conductances, with
// the potential scaled to 0 where the vapour is saturated and 1 in the drying air. The
// run only needs what wet nodes evaporate, so nodes of the gas are eliminated as they
// dry. The links that remain join wet nodes with each other, where nothing flows since
// all are at 0, and with the air, at 1: a wet node evaporates its conductance to the
// air.
#pragma once

#include "basics/compensated.h"
#include "boundary_layer.h"
#include "elimination/kron_fronts.h"

struct vapour {
    // Sites are the network's nodes, then the boundary layer's nodes level by level.
    int n_site;
    double *conductance; // (n_throat) area over length
    struct kron_fronts mesh;
};

// For a network that is full of liquid, under LAYER (not kept). With a TOLERANCE above
// 0 links on large fronts are floats. Lengths are in units of LENGTH (m), conductances
// are area over length in these units. Throats of radius KNUDSEN_RADIUS (m) have half
// the diffusivity, narrower ones less; 0: no Knudsen effect. The caller frees the
// result with vapour_free. The levels of LAYER are eliminated here, once.
struct vapour vapour_init(const struct network *network, double length,
                          double knudsen_radius, const struct boundary_layer *layer,
                          double tolerance);

// THROAT, from node A to node B, has emptied: vapour diffuses through it from now on.
// NODE has no throat with liquid any more: it leaves the system.
void vapour_open_throat(struct vapour *vapour, int throat, int a, int b);
void vapour_dry_node(struct vapour *vapour, int node);

// Rate into the drying air, scaled, if all menisci were flat.
double vapour_rate(const struct vapour *vapour);

// What wet NODE evaporates, scaled. Exactly 0 if no path leads from it to the air.
double vapour_evaporation(const struct vapour *vapour, int node);

void vapour_free(struct vapour *vapour);
