// SPDX-License-Identifier: GPL-3.0-or-later
// The rotation that fits pairs of directions best, by least squares.
#pragma once

#include "geometry/vector.h"

// Sums of a_i b_j over directions a and their images b. An empty one is {0}. Longer
// directions weigh more: they are not scaled to 1.
struct products {
    double of[3][3];
};

void add_products(struct products *sum, struct vector a, struct vector b);

struct rotation {
    double cosine;      // of half its angle
    struct vector axis; // times the sine of that
    double along;       // sum of b . (a rotated)
};

// The rotation with the largest ALONG [Horn, J. Opt. Soc. Am. A 4 (1987) 629], as a
// quaternion. The identity if it is not unique, to 1e-6, as for directions along one
// line or without any. Never a reflection.
struct rotation find_rotation(const struct products *sum);

// X turned by TURN about the origin; as long as before.
struct vector rotated(const struct rotation *turn, struct vector x);
