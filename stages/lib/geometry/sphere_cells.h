// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of a box that may repeat, each with the spheres that come near it: what lies
// around a place is found there, however much the sizes of spheres differ.
#pragma once

#include "geometry/packing.h"

#include <stdint.h>

// A grain, where its cell sees it; m.
struct sphere {
    struct vector centre;
    double radius;
};

// A sphere is listed in every cell that it comes near, so a search looks into one cell,
// or into those that a longer way crosses. Cells are numbered with z fastest. It owns
// OFFSET and SPHERE; m.
struct sphere_cells {
    int count[3]; // of cells along each axis
    bool repeats[3];
    double lower[3], per_length[3], period[3];
    double reach;          // a cell has the spheres that, so much larger, would meet it
    double largest;        // radius of all
    int64_t *offset;       // (cells + 1) those of cell c are sphere[offset[c]] ...,
    struct sphere *sphere; // the largest first; where the box repeats, each where it is
                           // seen from within the box
};

// O(n_particle), in time and memory: the more grains overlap, the fewer cells. Grains
// of kind GRAIN_AUXILIARY are not there. The caller frees it with sphere_cells_free.
// The packing is copied from, and may be freed before. Then it is only read, by any
// number of threads.
struct sphere_cells sphere_cells_init(const struct packing *packing);
void sphere_cells_free(struct sphere_cells *cells);

// Which cell along AXIS X lies in. Where the box repeats they are counted on beyond its
// sides; else those are in the last cell.
static inline int sphere_cell_along(const struct sphere_cells *cells, int axis,
                                    double x)
{
    const double at = floor((x - cells->lower[axis]) * cells->per_length[axis]);
    if (cells->repeats[axis]) return (int)at;
    return at > 0 ? at < cells->count[axis] ? (int)at : cells->count[axis] - 1 : 0;
}
