// SPDX-License-Identifier: GPL-3.0-or-later
// The tetrahedra of the regular triangulation of grains and walls, each with its pore
// [C 2.1]. A wall is a sphere of unlimited radius, so a cell has from one to four
// grains among its corners. All lengths are in units (cell_grains.h). Topology is
// decided by exact predicates on the grid of cell_grains.h, so equal input gives equal
// cells.
#pragma once

#include "network/cell_grains.h"

// A tetrahedron, positively oriented. Where the box repeats it stands for all its
// copies, and corners and neighbours may lie in other images.
struct pore_cell {
    int32_t corner[4];    // grains; -1..-6 for the walls -x, +x, -y, +y, -z, +z
    int32_t neighbour[4]; // cell opposite each corner; -1: none, beyond three walls
    struct image corner_image[4], neighbour_image[4];
    struct vector centre; // point of equal power, exactly on the walls among the
                          // corners; in a flat cell, that of a neighbour
    int32_t pore;         // cells whose centres coincide are one pore
};

// It owns .cell. Cells of one pore stand for one unknown pressure: n_pore <= n.
struct cells {
    int n, n_pore;
    struct pore_cell *cell;
    int n_hidden; // grains inside a larger one, which touch no cell
    int n_flat;   // cells without a centre of their own
};

// Corners of the facet opposite corner k, anticlockwise seen from outside the cell.
// Rows are k; the same order is that of throat.corner.
extern const int facet_corner[4][3];

// Places the grains of PACKING in GRAINS, with as many copies as needed, and
// triangulates. STATUS_BAD_DATA: a periodic box is too narrow, or as place_grains. The
// caller frees CELLS with cells_free and GRAINS with grains_free. Copies reach further,
// from 2 units on by doubling, until no copy left out could change a cell. O(n log n).
enum status find_cells(const struct packing *packing, struct grains *grains,
                       struct cells *cells, struct reason *reason);
void cells_free(struct cells *cells);

// Outward unit normal of wall 0..5.
static inline struct vector wall_normal(int wall)
{
    struct vector normal = {0, 0, 0};
    set_component(&normal, wall / 2, wall % 2 ? 1 : -1);
    return normal;
}

// How far a point is inside a wall of the box, units; below 0 beyond it.
static inline double wall_distance(const struct grains *grains, struct vector at,
                                   int wall)
{
    const double x = component(at, wall / 2);
    return wall % 2 ? component(grains->box, wall / 2) - x : x;
}

// Where corner k of CELL is: a grain.
static inline struct vector corner_position(const struct grains *grains,
                                            const struct pore_cell *cell, int k)
{
    return in_image(grains, grains->position[cell->corner[k]], cell->corner_image[k]);
}
