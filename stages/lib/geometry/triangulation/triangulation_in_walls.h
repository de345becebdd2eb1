// SPDX-License-Identifier: GPL-3.0-or-later
// The regular triangulation of weighted points between walls.
#pragma once

#include "geometry/triangulation/regular_triangulation.h"

// As triangulate, in any order, between the WALLS (bits of enum wall) of a box from the
// origin to UPPER, which are vertices too: wall 0..5 is -1..-6. A wall is the limit of
// a sphere that touches the box from outside: the bounding spheres of [C 3.1], of no
// limited radius in place of 10^6 boxes. Cells end at the walls; along a direction
// without walls, at the points. Lengths are best of the order of 1. -1: there is no
// cell. The caller frees with triangulation_free.
int triangulate_in_walls(const struct vector *points, const double *weights, int n,
                         unsigned walls, struct vector upper,
                         struct triangulation *triangulation);
