// SPDX-License-Identifier: GPL-3.0-or-later
// Which node of a network each cell of a grid belongs to, and what flows between them.
#pragma once

#include "network/network.h"
#include "support_grid.h"

// Of each cell of the grid (its layout) the node, -1: none, in whose tetrahedron of
// grains its middle lies, and how many boxes away from that node's own it lies there.
struct regions {
    int32_t *node;
    struct image *image;
};

// For an unmerged network in a box that repeats along x, y and z: exits 65 at another.
// The caller frees it with regions_free.
struct regions regions_of(const struct grid *grid, const struct network *network);
void regions_free(struct regions *regions);

// The fluxes between cells of two regions, summed by throat.
struct throat_fluxes {
    double (*along)[3]; // (n_throat) from first to second node
    double stray, all;  // absolute values: between nodes without a throat; all
};

// Adds to FLUXES the FLUX up through the lower face across AXIS of cell (i, j, k), of a
// mean gradient along ALONG.
void add_flux(struct throat_fluxes *fluxes, const struct grid *grid,
              const struct regions *regions, const struct network *network,
              const struct incidence *incidence, const int cell[3], int axis, int along,
              double flux);

// Writes a row a throat: its number and its fluxes for gradients along x, y, z,
// relative to the square of the grid's unit. Exits 73 and 74.
void write_fluxes(const char *path, const struct throat_fluxes *fluxes, int n_throat);
