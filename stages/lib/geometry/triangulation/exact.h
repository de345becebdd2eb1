// SPDX-License-Identifier: GPL-3.0-or-later
// What rounding must not decide: CGAL's exact arithmetic behind a C interface. Signs
// are those of exact numbers, whatever the coordinates: doubles are taken as they are.
// CGAL's predicates try intervals first and rational numbers only where these do not
// decide.
//
// Every function but the last is a question whose answer decides topology. They are
// asked only where an error bound in doubles does not decide (insertion_predicates.c):
// n_exact of struct triangulation counts how often. No function fails; coordinates must
// be finite.
#pragma once

#include "geometry/vector.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// m, m2; or any unit and its square.
struct weighted_point {
    struct vector at;
    double weight; // radius squared
};

// Walls of a box that all points are in. In the unit of the points.
struct wall_box {
    struct vector lower, upper;
};

// A corner of a cell: a grain or, where POINT is NULL, a wall, the limit of a sphere
// whose centre goes to infinity along an axis, to the side of SIGN, and whose surface
// is at PLANE.
struct corner_between {
    const struct weighted_point *point;
    int axis;
    double sign, plane;
};

// Whether three points lie on one line.
bool exact_collinear(const struct vector *a, const struct vector *b,
                     const struct vector *c);

// The sign of (p1 - p0) . ((p2 - p0) x (p3 - p0)): 1 for a positively oriented
// tetrahedron, 0 for a flat one.
int exact_orientation(const struct weighted_point *const p[4]);

// 1 when P[4] has less power to the point of equal power to the others, a positively
// oriented tetrahedron, than they have; -1 when more, 0 when the same.
int exact_power_side(const struct weighted_point *const p[5]);

// The sign of the determinant of the directions from E to three corners, that of a wall
// being its normal.
int exact_turn_between(const struct corner_between corner[3],
                       const struct weighted_point *e);

// As exact_power_side for E and four corners of a cell, a grain at least among them.
int exact_side_between(const struct corner_between corner[4],
                       const struct weighted_point *e);

// The point of equal power to four points, in rational arithmetic: for flat tetrahedra,
// where rounding could put it anywhere.
struct vector exact_power_centre(const struct weighted_point *const p[4]);

#ifdef __cplusplus
}
#endif
