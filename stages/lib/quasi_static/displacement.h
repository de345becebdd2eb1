// SPDX-License-Identifier: GPL-3.0-or-later
// Displacement of a grain; of the same shape, force and moment on it.
#ifndef CRAQUELURE_DISPLACEMENT_H
#define CRAQUELURE_DISPLACEMENT_H

#include "geometry/vector.h"

#include <math.h>

struct displacement {
    struct vector translation, rotation; // mean radii; rad
};

static const struct displacement no_displacement = {{0, 0, 0}, {0, 0, 0}};

static inline struct displacement displacement_scaled(double factor,
                                                      struct displacement a)
{
    return (struct displacement){scale(factor, a.translation),
                                 scale(factor, a.rotation)};
}

static inline struct displacement displacement_between(const struct displacement *from,
                                                       const struct displacement *to)
{
    return (struct displacement){subtract(to->translation, from->translation),
                                 subtract(to->rotation, from->rotation)};
}

// Subtracts LOAD from SUM.
static inline void displacement_subtract(struct displacement *sum,
                                         struct displacement load)
{
    *sum = displacement_between(&load, sum);
}

static inline double displacement_size(struct displacement a)
{
    return fmax(norm(a.translation), norm(a.rotation));
}

#endif
