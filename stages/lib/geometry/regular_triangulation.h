// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's regular triangulation behind a C interface: the dual of the power diagram,
// which is K's "Dirichlet" tessellation [K 3.2.3] and, for equal weights, Voronoi's.
#ifndef CRAQUELURE_REGULAR_TRIANGULATION_H
#define CRAQUELURE_REGULAR_TRIANGULATION_H

#include "geometry/image.h"
#include "geometry/vector.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// A tetrahedron, positively oriented, and what is found out about it later. Whoever
// goes from cell to cell waits for memory, so that all of it is on one cache line.
struct cell {
    int32_t vertex[4];    // points
    int32_t neighbour[4]; // cell opposite each vertex; -1: infinite
    struct vector at;     // where it has its node
    int32_t node;         // -1: none that is wanted
    struct image image;   // repetition of the box that `at` is in
    uint8_t seen;         // edges done with
};

static_assert(sizeof(struct cell) == 64, "one cache line");

// The infinite cells are left out. Exact predicates: also where many points are
// cospherical, and never a flat one.
struct triangulation {
    int n_cell;
    struct cell *cell;
};

// Triangulates N points with WEIGHTS (radius squared; NULL: all equal). Returns 0, or
// -1 when the points do not span three dimensions. The caller frees with
// triangulation_free.
int triangulate(const struct vector *points, const double *weights, int n,
                struct triangulation *triangulation);
void triangulation_free(struct triangulation *triangulation);

// The point of equal power to the four points CORNER, in rational arithmetic: for flat
// tetrahedra, where rounding could put it anywhere.
struct vector exact_power_centre(const struct vector *points, const double *weights,
                                 const int32_t corner[4]);

#ifdef __cplusplus
}
#endif

#endif
