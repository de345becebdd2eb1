// SPDX-License-Identifier: GPL-3.0-or-later
// How a grain moves: also, of the same shape, force and moment on one.
#ifndef CRAQUELURE_DISPLACEMENT_H
#define CRAQUELURE_DISPLACEMENT_H

#include "geometry/vector.h"

#include <math.h>

// Lengths in mean radii, stiffnesses in the largest of a joint.
struct displacement {
    struct vector shift, turn; // m over the unit of length; rad
};

static const struct displacement no_displacement = {{0, 0, 0}, {0, 0, 0}};

static inline struct displacement scaled(double share, struct displacement a)
{
    return (struct displacement){scale(share, a.shift), scale(share, a.turn)};
}

static inline struct displacement moved_from(const struct displacement *from,
                                             const struct displacement *to)
{
    return (struct displacement){subtract(to->shift, from->shift),
                                 subtract(to->turn, from->turn)};
}

// LOAD is taken off SUM.
static inline void pull(struct displacement *sum, struct displacement load)
{
    *sum = moved_from(&load, sum);
}

static inline double size_of(struct displacement a)
{
    return fmax(norm(a.shift), norm(a.turn));
}

#endif
