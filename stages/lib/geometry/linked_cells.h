// SPDX-License-Identifier: GPL-3.0-or-later
// Places sorted into the cells of a grid over a box that may repeat: what lies within
// WIDTH of a place is in its cell or one of the 26 around it.
//
// A look at all places within WIDTH of x, wherever the box repeats:
//     const int c[3] = {cell_along(&cells, 0, x.x), cell_along(&cells, 1, x.y),
//                       cell_along(&cells, 2, x.z)};
//     for each of the 27 cells around c, wrapped where the box repeats, once each:
//         for (int k = cells.offset[number]; k < cells.offset[number + 1]; k++)
//             look at place[cells.member[k]], by its nearest image.
// Trap: along an axis with fewer than three cells the cells around c come twice where
// it repeats. Made once, it is safe for several threads.
#pragma once

#include "geometry/vector.h"

#include <stdbool.h>

// The box along each axis: PERIOD 0 where it does not repeat, and then as wide as the
// places in it. LOWER counts only where it repeats.
struct box_of_places {
    double lower[3], period[3]; // m
};

// Cells are numbered with z fastest. It owns OFFSET and MEMBER. Members are indices of
// the N places, also if only some are chosen.
struct linked_cells {
    int count[3]; // along each axis
    double lower[3], per_length[3];
    bool repeats[3];
    int *offset, *member; // places of cell c are member[offset[c]] ..., rising
};

// Those of N places that CHOSEN (NULL: all) lists, N_CHOSEN of them, rising, in cells
// of WIDTH > 0 or more, about as many as places at most. O(n). The caller frees it with
// linked_cells_free. PLACE and CHOSEN are only read here.
struct linked_cells linked_cells_init(const struct box_of_places *box, int n,
                                      const struct vector *place, int n_chosen,
                                      const int *chosen, double width);
void linked_cells_free(struct linked_cells *cells);

// Which cell X lies in along AXIS; beyond the cells the last one, unless they repeat. 0
// to count - 1.
int cell_along(const struct linked_cells *cells, int axis, double x);

// Index in OFFSET of the cell that CELL counts along the axes.
int cell_number(const struct linked_cells *cells, const int cell[3]);
