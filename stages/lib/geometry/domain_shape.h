// SPDX-License-Identifier: GPL-3.0-or-later
// Convex bodies that grains lie in or around: what bounds them besides a box. All
// lengths in m. Nothing here knows of periodic boxes: body_near (packing.h) gives the
// repetition of a body that a place has to do with.
#pragma once

#include "geometry/vector.h"

#include <stdbool.h>
#include <stdint.h>

enum body_shape { BODY_BOX, BODY_CYLINDER, BODY_SPHERE, BODY_DISC, BODY_SHAPES };

// A cylinder stands along z, a disc (of a layer of grains) along y; both end at lower
// and upper. The radius of a round body is half its width along x. As in /domain/bodies
// of a packing.
struct body {
    uint8_t shape;              // enum body_shape
    uint8_t within;             // 1 where the grains lie in it, 0 around it
    struct vector lower, upper; // the box around it, m
};

// Whether lower is below upper. False where one is NAN.
static inline bool body_is_one(const struct body *body)
{
    const struct vector edge = subtract(body->upper, body->lower);
    return edge.x > 0 && edge.y > 0 && edge.z > 0;
}

// Whether it is round in the plane that AXIS, 0 to 2, lies in.
bool body_is_round(const struct body *body, int axis);
// What of X, a vector, counts for the round side: all for a sphere, without the
// component along the axis for a cylinder or disc, nothing for a box.
struct vector body_round_part(const struct body *body, struct vector x);

// Whether X lies in it or on its surface. Not of `within`: the set of points is that
// between its surfaces in either case.
bool body_holds(const struct body *body, struct vector x);

// The part of the line FROM + t (TO - FROM) that lies in it: from t = SPAN[0] to
// SPAN[1]. False when the line misses it.
bool body_span(const struct body *body, struct vector from, struct vector to,
               double span[2]);

// Unit vector away from its axis or centre through X, along x when X lies there; of a
// box along z.
struct vector body_outward(const struct body *body, struct vector x);

// The point of its surface, ends included, nearest to X, in it or outside. Where
// several are as near (X on an axis), one of them.
struct vector body_nearest(const struct body *body, struct vector x);

// The nearest point of the round side alone, which goes on beyond the ends of a
// cylinder or disc; for a box that of its surface.
struct vector body_nearest_round(const struct body *body, struct vector x);
