// SPDX-License-Identifier: GPL-3.0-or-later
// Displacement of a grain; of the same shape, force and moment on it. In the units of
// the engine: lengths in mean radii, stiffnesses in the largest of a pair, so forces in
// their product and moments in that times a mean radius. Translation and rotation then
// are of like size, and one number, displacement_size, judges both. One struct for
// displacements and for loads, because every operator here is symmetric in both: B maps
// the one, B^T the other.
#pragma once

#include "geometry/vector.h"

#include <math.h>

// As a load: force in stiffness times mean radius, moment in that times a mean radius.
struct displacement {
    struct vector translation, rotation; // mean radii; rad
};

static const struct displacement no_displacement = {{0, 0, 0}, {0, 0, 0}};

// FACTOR times A.
static inline struct displacement displacement_scaled(double factor,
                                                      struct displacement a)
{
    return (struct displacement){scale(factor, a.translation),
                                 scale(factor, a.rotation)};
}

// TO less FROM. Rotations are subtracted as vectors: small ones.
static inline struct displacement displacement_between(const struct displacement *from,
                                                       const struct displacement *to)
{
    return (struct displacement){subtract(to->translation, from->translation),
                                 subtract(to->rotation, from->rotation)};
}

// Subtracts LOAD from SUM. The order in which loads are subtracted fixes the rounding:
// pair after pair.
static inline void displacement_subtract(struct displacement *sum,
                                         struct displacement load)
{
    *sum = displacement_between(&load, sum);
}

// The larger of |translation| and |rotation|.
static inline double displacement_size(struct displacement a)
{
    return fmax(norm(a.translation), norm(a.rotation));
}
