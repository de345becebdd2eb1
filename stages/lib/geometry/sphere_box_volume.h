// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes of spheres, and of what two of them share, inside an axis-parallel box.
#pragma once

#include "geometry/vector.h"

#include <stdbool.h>

// Volume of a sphere about the origin that lies between LOWER and UPPER, m^3. Closed
// form; to 1e-14 of the sphere's volume. LOWER and UPPER may be infinite (HUGE_VAL):
// that side does not cut.
double sphere_in_box(double radius, struct vector lower, struct vector upper);

// Volume that two spheres share, their centres DISTANCE apart, m^3. Closed form.
double lens_volume(double first, double second, double distance);

// What two spheres share, the first about the origin, the second at APART.
struct lens {
    double first, second; // radii, m
    struct vector apart;
    double distance, volume;    // m, m^3
    struct vector lower, upper; // the box around it, m
    bool inside;                // one sphere lies in the other
    struct vector middle;       // of that one
};

// The lens of radii FIRST and SECOND, m; its volume is 0 where they do not meet. All is
// relative to the first centre.
struct lens lens_between(double first, double second, struct vector apart);

// The part of it between LOWER and UPPER, m^3. Exact, to 1e-14 of the spheres, where
// planes of one direction cut it. Where planes of two do, along an edge, both shares
// multiplied: a lens is small.
double lens_in_box(const struct lens *lens, struct vector lower, struct vector upper);
