// SPDX-License-Identifier: GPL-3.0-or-later
// The regular triangulation of weighted points between walls.
#ifndef CRAQUELURE_WALLED_TRIANGULATION_H
#define CRAQUELURE_WALLED_TRIANGULATION_H

#include "geometry/regular_triangulation.h"

#ifdef __cplusplus
extern "C" {
#endif

// As triangulate, between the WALLS (bits of enum wall) of a box from the origin to
// UPPER, which are vertices too: wall 0..5 is -1..-6. A wall is the limit of a sphere
// that touches the box from outside: the bounding spheres of [C 3.1], but of 2^100 in
// place of 10^6 boxes, which costs no digits, for those tests are exact as well.
// Infinite cells lie beyond the walls; along a direction without walls, beyond the
// points. Lengths are best of the order of 1. The caller frees with triangulation_free.
int triangulate_in_walls(const struct vector *points, const double *weights, int n,
                         unsigned walls, struct vector upper,
                         struct triangulation *triangulation);

#ifdef __cplusplus
}
#endif

#endif
