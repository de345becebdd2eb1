// SPDX-License-Identifier: GPL-3.0-or-later
// Quasi-steady vapour transport [K 3.9] through the empty throats and the boundary
// layer.
//
// With the potential ln(1 - p_v/p_g), K 3.9 is linear. It is solved for the deficit:
// the potential scaled to 0 where the vapour is saturated and 1 in the drying air. Then
// wet nodes give no right-hand side, the matrix is a symmetric M-matrix, and its
// Cholesky solution is a sum of positive terms: gas that is shut in between wet nodes
// comes out saturated exactly, and small fluxes deep inside keep their digits.
#ifndef CRAQUELURE_VAPOUR_H
#define CRAQUELURE_VAPOUR_H

#include "boundary_layer.h"
#include "compensated.h"

#include <stdbool.h>

// Largest error of a vapour balance, relative to the drying rate.
#define VAPOUR_TOLERANCE 1e-12

// From one site to another. Sites are the network's nodes, then the boundary layer's
// nodes level by level, then the drying air.
struct vapour_link {
    int site;
    int throat; // open to vapour only when it is empty; -1: always
    double conductance;
};

struct vapour_solver; // the factorised matrix

struct vapour {
    int n_site; // without the drying air, which is site n_site
    int *offset;
    struct vapour_link *link; // of site i: link[offset[i]] .. link[offset[i+1]-1]
    bool *open;               // (n_throat) empty, so that vapour passes
    bool *dry;                // (n_site) gas without liquid beside it: deficit unknown
    // (n_site+1) In two parts: across a link of large conductance, as in a thin
    // boundary layer or along a thick one, deficits differ by less than the last digit
    // of one.
    struct compensated *deficit;
    double rate;     // into the drying air
    double residual; // largest so far, of the rate
    bool changed;    // since the last solution
    struct vapour_solver *solver;
};

// For a network that is full of liquid. Lengths are in units of LENGTH (m),
// conductances area over length in the same.
struct vapour vapour_make(const struct network *network, double length,
                          const struct boundary_layer *layer);

// THROAT has emptied; NODE has gas and no liquid beside it any more.
void vapour_open_throat(struct vapour *vapour, int throat);
void vapour_dry_node(struct vapour *vapour, int node);

// Potentials and rate for the gas as it is now; costs nothing if no node has dried
// since the last call, for then none of them changes. STATUS_NOT_CONVERGED if the
// balances do not close to VAPOUR_TOLERANCE: at any one site, or over all of them.
enum status vapour_solve(struct vapour *vapour, struct reason *reason);

// What a wet node gives off. Exactly 0 if no way leads from it to the drying air.
double vapour_evaporation(const struct vapour *vapour, int node);

void vapour_free(struct vapour *vapour);

#endif
