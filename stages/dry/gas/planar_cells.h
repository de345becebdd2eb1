// SPDX-License-Identifier: GPL-3.0-or-later
// The Voronoi diagram of points in a region of a rectangle: the area that is nearest to
// each point, and the edge that each two neighbours share.
#pragma once

#include "planar_region.h"

// The edge between the cells of two points. Two cells may share several where the
// rectangle repeats.
struct planar_edge {
    int point[2];    // lower first
    double width;    // in the region
    double distance; // between the points
    struct planar end[2];
};

struct planar_cells {
    double *area; // (n) they sum to the area of the region
    int n_edge;
    struct planar_edge *edge; // (n_edge) by points, ascending
};

// POINT are N distinct points in the rectangle, however close. Edges too narrow to tell
// from rounding are left out. About O(n) for points spread evenly, also along one line.
// The caller frees the result with planar_cells_free. Each cell is clipped by itself,
// in coordinates from its own point: small cells keep their digits.
struct planar_cells planar_cells_init(const struct planar *point, int n,
                                      const struct planar_region *region);

void planar_cells_free(struct planar_cells *cells);
