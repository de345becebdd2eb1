// SPDX-License-Identifier: GPL-3.0-or-later
// The regular triangulation of weighted points: the dual of the power diagram, which is
// K's "Dirichlet" tessellation [K 3.2.3] and, for equal weights, Voronoi's.
//
// A point is in a cell's sphere where its power, |x - centre|^2 - weight, is below that
// of the vertices; the triangulation has no such point. To walk around it:
//     for (int k = 0; k < 4; k++) {
//         const int32_t next = t.cell[c].neighbour[k]; // across the facet opposite k
//         if (next >= 0) ...
//     }
// Made by one thread; safe to read for several. Memory: 64 bytes a cell while it is
// made, 32 in the end; points that fill space have 6.8 cells each.
#pragma once

#include "basics/memory.h"
#include "geometry/image.h"
#include "geometry/triangulation/exact.h"
#include "geometry/vector.h"

#include <stdint.h>

// A tetrahedron, positively oriented. Whoever goes from cell to cell waits for memory,
// so that there is nothing else, and half a cache line is enough.
struct cell {
    int32_t vertex[4];    // points
    int32_t neighbour[4]; // cell opposite each vertex; -1: infinite
};

enum { SHARES_NODE = 1 << 7 }; // other cells may have the same node

// Where X is among FOUR, known to be there. Without branches, which would be guesses.
static inline int index_among(const int32_t four[4], int32_t x)
{
    return (four[1] == x) + 2 * (four[2] == x) + 3 * (four[3] == x);
}

// The infinite cells are left out. What is found out about cells later is NULL until
// then; whoever finds it out allocates it. It owns its arrays; triangulation_free frees
// them.
struct triangulation {
    int n_cell;
    struct cell *cell;
    int64_t n_test, n_exact; // sphere tests made, and those that took exact numbers

    int32_t *node;       // (n_cell) -1: none that is wanted
    struct image *image; // (n_cell) of the node; NULL unless the box repeats
    uint8_t *seen;       // (n_cell) edges done with; SHARES_NODE
};

// The repetition of the box that the node of a cell is seen in. {0} where it does not
// repeat.
static inline struct image node_image(const struct triangulation *triangulation, int c)
{
    return triangulation->image ? triangulation->image[c] : (struct image){0};
}

// For loops over all cells that look at neighbours: asks in time for those of a cell
// soon to come.
PREFETCHING expect_neighbours(const struct triangulation *triangulation, int cell)
{
    enum { AHEAD = 24 };
    if (cell + AHEAD >= triangulation->n_cell) return;
    for (int k = 0; k < 4; k++) {
        const int32_t next = triangulation->cell[cell + AHEAD].neighbour[k];
        if (next >= 0) __builtin_prefetch(&triangulation->cell[next]);
    }
}

// Triangulates N points (weight: radius squared) in the order given; O(n log n) for
// points that fill space in insertion_order. Which cells there are depends on the
// points alone: tests are exact, also where many points are cospherical (then
// lexicographically later points count as a little lighter than they are), and no cell
// is flat. A point that another has engulfed is in no cell. Cells come in the order of
// their last points: close in space, close in memory. Returns 0, or -1 when the points
// do not span three dimensions. The caller frees with triangulation_free. POINTS are
// only read, and not needed afterwards.
int triangulate(const struct weighted_point *points, int n,
                struct triangulation *triangulation);

// The same between the six walls of a box that all points are in: planes, in the limit
// of spheres that touch the box from outside. WALLS (bits) are vertices: wall 0..5 is
// -1..-6; cells at the others, which serve to end the triangulation, are left out. N >=
// 1. Freed alike.
struct triangulation triangulate_between(const struct weighted_point *points, int n,
                                         const struct wall_box *box, unsigned walls);
void triangulation_free(struct triangulation *triangulation);
