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
#include "kept_vapour.h"

struct vapour {
    // Sites are the network's nodes, then the boundary layer's nodes level by level.
    int n_site;
    double *conductance; // (n_throat) area over length
    struct kron_fronts mesh;
    struct kept_vapour *kept; // in place of MESH; NULL: exact
};

// For a network that is full of liquid, under LAYER (not kept). With a TOLERANCE above
// 0 links on large fronts are floats. Lengths are in units of LENGTH (m), conductances
// are area over length in these units. Throats of radius KNUDSEN_RADIUS (m) have half
// the diffusivity, narrower ones less; 0: no Knudsen effect. With a STEP above 0 the
// potentials are kept until they may be wrong by this share of the rate. The caller
// frees the result with vapour_free. The levels of LAYER are eliminated here, once.
struct vapour vapour_init(const struct network *network, double length,
                          double knudsen_radius, const struct boundary_layer *layer,
                          double tolerance, double step);

// THROAT, from node A to node B, has emptied: vapour diffuses through it from now on.
// NODE has no throat with liquid any more: it leaves the system. Potentials that are
// kept change at kept_vapour_follow.
void vapour_open_throat(struct vapour *vapour, int throat, int a, int b);
void vapour_dry_node(struct vapour *vapour, int node);

// What wet nodes evaporate. _forget_reached empties the list of those reached.
static inline const struct air_links *vapour_air(const struct vapour *vapour)
{
    return vapour->kept ? &vapour->kept->air : &vapour->mesh.air;
}

// Their sum: the rate into the drying air, scaled, if all menisci were flat. Where
// potentials are kept the rate is that times _pace, which stands for what has not yet
// reached wet nodes: everything happens so much faster, 1 or more.
double vapour_rate(const struct vapour *vapour);
double vapour_pace(const struct vapour *vapour);
void vapour_forget_reached(struct vapour *vapour);

// What wet NODE evaporates, scaled. Exactly 0 if no path leads from it to the air.
double vapour_evaporation(const struct vapour *vapour, int node);

// Keeps or restores all that changes. Whether what was restored can be one.
void vapour_state(struct vapour *vapour, struct checkpoint_stream *stream);
bool vapour_fits(const struct vapour *vapour);

void vapour_free(struct vapour *vapour);
