// SPDX-License-Identifier: GPL-3.0-or-later
// The turn that takes directions to others best, by least squares.
#ifndef CRAQUELURE_DEFORM_ROTATION_H
#define CRAQUELURE_DEFORM_ROTATION_H

#include "geometry/vector.h"

// Sums over directions a and what they have become, b, of a_i b_j.
struct products {
    double of[3][3];
};

void add_products(struct products *sum, struct vector a, struct vector b);

struct rotation {
    double cosine;      // of half its angle
    struct vector axis; // times the sine of that
    double along;       // sum of b . (a turned)
};

// The turn of most ALONG [Horn, J. Opt. Soc. Am. A 4 (1987) 629]. None where others do
// as well, as of directions along one line.
struct rotation find_rotation(const struct products *sum);

struct vector rotated(const struct rotation *turn, struct vector x);

#endif
