// SPDX-License-Identifier: GPL-3.0-or-later
// The throats between pores: their geometry and what they conduct [C 2.2.2]. A throat
// is a facet between two cells, with the double pyramid from it to their two centres.
// Everything is in units (cell_grains.h), conductances in unit^3 for a viscosity of 1.
#pragma once

#include "network/pore_cells.h"

#include <stddef.h>

enum sides {
    SIDES_NO_SLIP,
    SIDES_SYMMETRIC,     // the surface of walls is left out of [C 9, 18]
    SIDES_SYMMETRIC_YADE // and the hydraulic radius at walls is smaller: see below
};

// How volume and surface are counted when both centres lie on one side of the facet.
enum facet_pieces {
    PIECES_SIGNED,  // the nearer part is subtracted from the farther: a partition
    PIECES_UNSIGNED // each grain's share is counted twice, as Yade does
};

// By hydraulic radius [C 8], effective radius [C 10], or the open section as in
// tessellate.
enum conductance { CONDUCTANCE_HYDRAULIC, CONDUCTANCE_EFFECTIVE, CONDUCTANCE_SECTION };

// How the resistance of throats is computed [C 2.2.2].
struct throat_rule {
    enum sides sides;
    enum conductance conductance;
    enum facet_pieces facet_pieces;
    double factor; // alpha [C 8]
};

// In units; conductances for a viscosity of 1.
struct throat {
    int32_t cell[2];
    int32_t corner[3];  // as in struct pore_cell
    struct image image; // of the second cell, seen from the first
    struct vector area; // S_ij n_ij, from the first to the second
    double sector[3];   // A^k_ij; at most the area in sum
    double surface[3];  // gamma^k_ij that resists
    double volume, length;
    double conductance; // K_ij = g_ij / L_ij [C 20]; 0: closed
};

// It owns .throat.
struct throats {
    int n, n_closed;
    struct throat *throat;
};

// One throat a facet, in the order of the first cell. A facet inside a pore does not
// resist: it has length 0 and conductance 0 and takes no part in the balances.
//
// At walls Yade multiplies the hydraulic radius by 2^(-1/4), at edges by 4^(-1/4), with
// symmetric sides; the paper does not.
//
// In overlap the sectors may cover more than the facet: they are scaled down to it, and
// the throat is closed. The caller frees with throats_free.
struct throats find_throats(const struct grains *grains, const struct cells *cells,
                            const struct throat_rule *rule);
void throats_free(struct throats *throats);

// A^f_ij, the part of the facet in the fluid.
double fluid_area(const struct throat *throat);

// Corner K of a facet of CELL, opposite to corner FACET.
struct corner facet_corner_of(const struct grains *grains, const struct pore_cell *cell,
                              int facet, int k);

// From the centre of the first cell to that of the second.
struct vector throat_step(const struct grains *grains, const struct cells *cells,
                          const struct throat *throat);
