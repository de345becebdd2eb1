// SPDX-License-Identifier: GPL-3.0-or-later
// Solid angles of triangles seen from the origin (A. van Oosterom, J. Strackee, The
// solid angle of a plane triangle, IEEE Trans. Biomed. Eng. 30, 125, 1983).
//
// Why no other formula: by spherical excess a narrow triangle loses all of its digits,
// and arc cosines lose half of them near 0. Here numerator and denominator are sums of
// products, and one atan2 takes both; angles beyond 2 pi of a polygon come out modulo 4
// pi.
#pragma once

#include "geometry/vector.h"

// A number whose argument is half a solid angle. Two multiplied add their angles, so a
// polygon takes one arc tangent. Neither part is normalised: only their quotient
// counts.
struct half_angle {
    double real, imaginary;
};

// Solid angle Omega of the triangle U V W, positive where they turn anticlockwise seen
// from outside: with a, b, c the lengths of U, V, W
//     tan(Omega / 2) = (U x V).W / (a b c + (U.V) c + (V.W) a + (W.U) b),
// numerator and denominator being the imaginary and the real part. No length may be 0
// for the angle to mean something. Both parts scale with the cube of lengths: in units
// of a grain's radius products of many neither overflow nor vanish.
static inline struct half_angle half_solid_angle(struct vector u, struct vector v,
                                                 struct vector w)
{
    const double a = norm(u), b = norm(v), c = norm(w);
    return (struct half_angle){
        a * b * c + dot(u, v) * c + dot(v, w) * a + dot(w, u) * b, dot(cross(u, v), w)};
}

// The solid angle of TO less that of FROM, between -2 pi and 2 pi, sr.
static inline double solid_angle_between(struct half_angle from, struct half_angle to)
{
    return 2 * atan2(to.imaginary * from.real - from.imaginary * to.real,
                     to.real * from.real + to.imaginary * from.imaginary);
}
