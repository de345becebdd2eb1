// SPDX-License-Identifier: GPL-3.0-or-later
// The void between spheres on a regular grid: how much of each face of each cell is
// open.
#pragma once

#include "geometry/packing.h"

#include <stddef.h>

// Cells 1..n along each axis, with a layer of cells around them; cell (i, j, k) is
// i stride[0] + j stride[1] + k stride[2]. Lengths are in cube roots of the box's
// volume.
struct grid {
    int n[3];
    size_t stride[3], size;
    double spacing[3], edge[3]; // of a cell, of the box
    double unit;                // m
    uint8_t periodic[3];
    float *open[3]; // (size) share of each cell's lower face along an axis that is open
};

// CELLS of the cube root of the box's volume along it. Faces less discs, exactly; where
// spheres overlap what they share counts twice, as long as a face has room. Faces in
// walls are open like any other. The caller frees it with grid_free.
struct grid grid_of(const struct packing *packing, int cells);
void grid_free(struct grid *grid);

// What the spheres leave of the box, what two share counted twice.
double void_share(const struct packing *packing);

// Area of the part of a disc of RADIUS about the origin between LOWER and UPPER.
double disc_in_rectangle(double radius, const double lower[2], const double upper[2]);

// A cell of the grid by its place.
static inline size_t cell_at(const struct grid *grid, int i, int j, int k)
{
    return (size_t)i * grid->stride[0] + (size_t)j * grid->stride[1] +
           (size_t)k * grid->stride[2];
}
