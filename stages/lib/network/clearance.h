// SPDX-License-Identifier: GPL-3.0-or-later
// How wide the way between grains is along a throat.
#ifndef CRAQUELURE_CLEARANCE_H
#define CRAQUELURE_CLEARANCE_H

#include "geometry/vector.h"

enum clearance {
    CLEARANCE_SEGMENT, // least distance from the throat itself to the grains beside it
    CLEARANCE_LINE     // [K 3.7]: least distance from the infinite line through it
};

// How far the surface of a grain is from the throat between END [K 3.7, 3.8]; below 0
// where they overlap.
static inline double clearance_of(struct vector centre, double radius,
                                  const struct vector end[2], enum clearance how)
{
    const struct vector along = subtract(end[1], end[0]);
    const struct vector to = subtract(centre, end[0]);
    const double length2 = dot(along, along);
    double t = length2 > 0 ? dot(to, along) / length2 : 0;
    if (how == CLEARANCE_SEGMENT) t = t < 0 ? 0 : t > 1 ? 1 : t;
    return norm(subtract(to, scale(t, along))) - radius;
}

#endif
