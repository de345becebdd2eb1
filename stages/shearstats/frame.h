// SPDX-License-Identifier: GPL-3.0-or-later
// Coordinates and local directions: Cartesian (x, y, z), or cylindrical about an axis
// (r, angle, z along it), whose directions turn from place to place. Nothing depends on
// the angle, which is therefore always 0.
#pragma once

#include "geometry/vector.h"

#include <stdbool.h>

// POINT and AXIS count only if cylindrical.
struct frame {
    bool cylindrical;
    struct vector point, axis; // a point on the axis, m; its unit vector
};

// Row k of DIRECTION gives component k; they are right-handed.
struct place {
    double at[3];               // coordinates: m, or m, 0, m
    struct vector direction[3]; // unit vectors of the components
    double r;                   // distance from the axis; 0 in Cartesian coordinates
};

// On the axis, where r has no direction, any direction across it serves: what is spread
// there has r = 0. The directions are r, the angle, z: right-handed, with the axis as
// the third.
static inline struct place place_of(const struct frame *frame, struct vector x)
{
    if (!frame->cylindrical)
        return (struct place){{x.x, x.y, x.z}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0};
    const struct vector from = subtract(x, frame->point), up = frame->axis;
    const double z = dot(from, up);
    const struct vector out = subtract(from, scale(z, up));
    const double r = norm(out);
    const struct vector any =
        fabs(up.x) < 0.5 ? (struct vector){1, 0, 0} : (struct vector){0, 1, 0};
    struct vector radial = r > 0 ? out : cross(up, any);
    radial = scale(1 / norm(radial), radial);
    return (struct place){{r, 0, z}, {radial, cross(up, radial), up}, r};
}

// COMPONENT_OF[k] = direction k . V. A tensor f l is turned by turning both vectors.
static inline void local_components(const struct place *place, struct vector v,
                                    double component_of[3])
{
    for (int k = 0; k < 3; k++)
        component_of[k] = dot(place->direction[k], v);
}
