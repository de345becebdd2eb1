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
    uint8_t seen;       // edges done with
};

static_assert(sizeof(struct cell) == 64, "one cache line");

// The infinite cells are left out.
struct triangulation {
    int n_cell;
    struct cell *cell;
    int64_t n_test, n_exact; // sphere tests made, and those that took exact numbers
};

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
