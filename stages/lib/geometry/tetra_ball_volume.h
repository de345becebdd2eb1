// SPDX-License-Identifier: GPL-3.0-or-later
// Spheres and the cells around them: how much of a polyhedral cell lies outside the
// grain in it.
//
// Of a cell around a grain: shift the grain's centre to the origin, cut each face into
// triangles, counter-clockwise seen from outside, and sum over them. The void of a
// throat is such a sum over the triangles beside it (network/void_volume.h).
#pragma once

#include "geometry/vector.h"

// Volume of the tetrahedron between the origin and the triangle A B C that lies outside
// the ball of RADIUS about the origin, m^3; negative when A B C run clockwise seen from
// outside. Over the triangles of a closed surface these sum to its volume outside the
// ball, wherever the origin is. Closed form, also where the ball pokes through the
// triangle; to 1e-15 of the ball or the tetrahedron.
double tetrahedron_outside_ball(double radius, struct vector a, struct vector b,
                                struct vector c);
