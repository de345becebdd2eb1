// SPDX-License-Identifier: GPL-3.0-or-later
// A cell of a triangulation that is being made, and its sphere: that which is
// orthogonal to the spheres of its four points, |at - p|^2 - w_p the same for each (an
// empty circumsphere where all weights w are 0). `error` bounds its rounding, so that
// most points are told inside or outside without exact arithmetic.
#pragma once

#include "geometry/triangulation/exact.h"

#include <assert.h>

enum { INFINITE = -1, FIRST_WALL = -2 }; // in place of a vertex; walls 0..5 go down

// The plane that VERTEX, FIRST_WALL or below, stands for; `sign` is 1 at an upper wall
// of BOX, -1 at a lower one.
static inline struct corner_between wall_corner(const struct wall_box *box,
                                                int32_t vertex)
{
    const int wall = FIRST_WALL - vertex, axis = wall / 2;
    return (struct corner_between){
        .axis = axis,
        .sign = wall % 2 ? 1 : -1,
        .plane = component(wall % 2 ? box->upper : box->lower, axis)};
}

// Neighbour k is opposite vertex k. A finite cell is positively oriented. In a box
// walls are among the first three vertices only: the last is the point that made the
// cell.
struct live_cell {
    int32_t vertex[4], neighbour[4];
    struct vector at; // centre of power, from the last vertex
    float error;      // of each coordinate, at most; below 0: infinite
    uint8_t seen;     // in the cavity, or no longer there
};

static_assert(sizeof(struct live_cell) == 64, "one cache line");

// Finds the centres of COUNT cells, WHICH among CELLS, and how far off they may be by
// rounding. They have their vertices, of which one may be infinite or, in a BOX, the
// first three walls. BOX is NULL where there are none. Together, because four are found
// side by side in a vector.
void find_centres(const struct weighted_point *point, const struct wall_box *box,
                  struct live_cell *cells, const int32_t *which, int count);
