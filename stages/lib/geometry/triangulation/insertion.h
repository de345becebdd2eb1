// SPDX-License-Identifier: GPL-3.0-or-later
// Inside of the incremental insertion only: a triangulation under way, and which cells
// a point takes away. The places of cells that are gone are used again. `point` and
// `box` are the caller's and must stay as they are.
#pragma once

#include "geometry/triangulation/insertion_cell.h"

#include <float.h>

// A facet between a cell that goes and one that stays. Its vertices come so that with
// the new point they are positively oriented. The new point and this facet make a cell.
struct facet {
    int32_t vertex[3];
    int32_t beyond; // the cell that stays
    int32_t back;   // its neighbour across the facet
};

// An entry of a hash table of the directed edges of the rim; those of other points than
// the one being inserted count as empty. An edge of the rim is shared by two new cells:
// the second finds the first here.
struct edge {
    int32_t from, to;
    int32_t inserted;
    int32_t cell;
};

// It owns CELL, CAVITY, RIM, UNUSED and EDGE; they only grow, and growing moves them:
// no pointer into CELL outlives a new cell. n_test and n_exact count sphere tests, and
// those that took exact numbers. `cell` has infinite cells, too, and holes (UNUSED).
struct insertion {
    const struct weighted_point *point;
    const struct wall_box *box; // NULL: no walls
    struct live_cell *cell;
    int32_t *cavity; // cells
    struct facet *rim;
    int32_t *unused; // cells
    struct edge *edge;
    int n_cell, cell_capacity;
    int n_cavity, cavity_capacity;
    int n_rim, rim_capacity;
    int n_unused, unused_capacity;
    uint32_t edge_mask; // length of the table, a power of two, less one
    int32_t last;       // a cell made last
    int64_t n_test, n_exact;
};

// The sense of turn (-1, 0, 1) of four points. Exact. 1: positively oriented, 0: in one
// plane.
int orientation(const struct weighted_point *const p[4]);

// That of the corners of a cell with point E in place of corner K: 1 where E is on the
// same side of the facet opposite K as corner K is. A wall lies along its normal.
int orientation_with(const struct insertion *insertion, const int32_t vertex[4], int k,
                     int32_t e);

// As takes() where rounding could decide, and for infinite cells. Ties are broken as
// regular_triangulation.h says.
bool takes_exactly(struct insertion *insertion, const struct live_cell *cell,
                   int32_t e);

// Whether point E takes a cell away: whether it has less power to the cell's centre
// than the vertices have. With q = E - last vertex and c the centre from there, the
// power of E less that of the vertices is |q|^2 + w_last - w_E - 2 q.c. BOUND is what
// rounding of c (cell->error) and of these sums can do; nearly all points are told
// apart by it.
static inline bool takes(struct insertion *insertion, const struct live_cell *cell,
                         int32_t e)
{
    const bool infinite = cell->error < 0;
    const struct weighted_point *p = &insertion->point[e];
    const struct weighted_point *last =
        &insertion->point[infinite ? e : cell->vertex[3]];
    const struct vector to = subtract(p->at, last->at);
    const double square = dot(to, to), lighter = last->weight - p->weight;
    const double power = square + lighter - 2 * dot(to, cell->at);
    const double bound =
        2 * (double)cell->error * (fabs(to.x) + fabs(to.y) + fabs(to.z)) +
        8 * DBL_EPSILON * (square + fabs(lighter));
    if (__builtin_expect(infinite || !(fabs(power) > bound), 0))
        return takes_exactly(insertion, cell, e);
    return power < 0;
}
