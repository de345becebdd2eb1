// SPDX-License-Identifier: GPL-3.0-or-later
// The regular triangulation of weighted points: the dual of the power diagram, which is
// K's "Dirichlet" tessellation [K 3.2.3] and, for equal weights, Voronoi's.
#ifndef CRAQUELURE_REGULAR_TRIANGULATION_H
#define CRAQUELURE_REGULAR_TRIANGULATION_H

#include "geometry/image.h"
#include "geometry/vector.h"

#include <stdint.h>

// A tetrahedron, positively oriented, and what is found out about it later. Whoever
// goes from cell to cell waits for memory, so that all of it is on one cache line.
struct cell {
    int32_t vertex[4];    // points
    int32_t neighbour[4]; // cell opposite each vertex; -1: infinite
    struct vector at;     // where it has its node
    union {
        int32_t node; // -1: none that is wanted
        float error;  // of `at`, while triangulating
    };
    struct image image; // repetition of the box that `at` is in
    uint8_t seen;       // edges done with; SHARES_NODE
};

enum { SHARES_NODE = 1 << 7 }; // other cells may have the same node

static_assert(sizeof(struct cell) == 64, "one cache line");

// Where X is among FOUR, known to be there. Without branches, which would be guesses.
static inline int index_among(const int32_t four[4], int32_t x)
{
    return (four[1] == x) + 2 * (four[2] == x) + 3 * (four[3] == x);
}

// The infinite cells are left out.
struct triangulation {
    int n_cell;
    struct cell *cell;
    int64_t n_test, n_exact; // sphere tests made, and those that took exact numbers
};

// For loops over all cells that look at neighbours: asks in time for those of a cell
// soon to come.
static inline void expect_neighbours(const struct triangulation *triangulation,
                                     int cell)
{
    enum { AHEAD = 8 };
    if (cell + AHEAD >= triangulation->n_cell) return;
    for (int k = 0; k < 4; k++) {
        const int32_t next = triangulation->cell[cell + AHEAD].neighbour[k];
        if (next >= 0) __builtin_prefetch(&triangulation->cell[next]);
    }
}

// Triangulates N points with WEIGHTS (radius squared; NULL: all equal). O(n log n) for
// points that fill space. Which cells there are depends on the points alone: tests are
// exact, also where many points are cospherical (then lexicographically later points
// count as a little lighter than they are), and no cell is flat. A point that another
// has engulfed is in no cell. Cells close in space are close in memory. Returns 0, or
// -1 when the points do not span three dimensions. The caller frees with
// triangulation_free.
int triangulate(const struct vector *points, const double *weights, int n,
                struct triangulation *triangulation);
void triangulation_free(struct triangulation *triangulation);

#endif
