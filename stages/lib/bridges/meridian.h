// SPDX-License-Identifier: GPL-3.0-or-later
// The meridian of a capillary bridge: an arc of constant mean curvature between two
// bodies, all lengths over the effective radius [G 1], so that the curvatures of the
// bodies sum to 2.
//
// With radius y, slope angle psi and mean curvature H (positive under suction), Young
// and Laplace's equation [K 2.2] along the arc s is dpsi/ds = cos(psi)/y + 2H. Then
// z = y exp(i psi) obeys dz/ds = i (1 + 2 H z), which is solved by
//     z(s) = z(0) exp(2iHs) + i exp(iHs) sin(Hs)/H,
// for every shape: nodoid, catenoid (H = 0), unduloid, cylinder and sphere. Only height
// and volume are integrals. Nothing here is singular at H = 0, on a plane, or for the
// cylinder.
#pragma once

#include <stdbool.h>

// Two bodies, a sphere each or one of them a plane (curvature 0), the second above the
// first.
struct bodies {
    double curvature[2];     // not negative; their sum is 2
    double contact_angle[2]; // rad
};

// Whether both are alike: a bridge between them has a symmetric shape.
bool bodies_are_equal(const struct bodies *bodies);

// An arc, by four numbers that stay regular for every shape.
enum { ARC_FIRST, ARC_SECOND, ARC_LENGTH, ARC_TURN, ARC_NUMBERS };
struct arc {
    double reach[2]; // along each body from its pole to the contact line
    double length;   // of the arc
    double turn;     // H times length
};

// What an arc spans, and how it changes with the logarithms of reaches and length and
// with the turn.
struct span {
    // By which the end of the arc misses the slope and radius that the second body and
    // its contact angle ask for: real and imaginary part.
    double miss[2];
    double gap;    // between the poles of the bodies
    double volume; // between arc and bodies, their common part counted twice
    double area;   // of the free surface
    double miss_slope[2][ARC_NUMBERS], gap_slope[ARC_NUMBERS],
        volume_slope[ARC_NUMBERS];
    double waist_slope[ARC_NUMBERS]; // of half the squared radius in the arc's middle
};

// The contact line of body WHICH: where a cap of the body ends.
struct contact_line {
    double angle;    // half-filling angle, rad
    double radius;   // of the circle
    double sagitta;  // height of the cap
    double cap;      // its volume
    double wet_area; // its surface
};
struct contact_line contact_line(const struct bodies *bodies, int which, double reach);

// In units of the bodies (see their curvatures). Also of an arc that is no equilibrium:
// MISS says by how much.
struct span span_of(const struct bodies *bodies, const struct arc *arc);

// The force over 2 pi times surface tension: y cos(psi) + H y^2, the same all along
// [K 2.3].
double arc_force(const struct bodies *bodies, const struct arc *arc);

// The least radius on the arc.
double arc_neck(const struct bodies *bodies, const struct arc *arc);

// Height above the first body's pole and radius at COUNT (at least 2) places, evenly
// along the arc, both ends included.
void arc_profile(const struct bodies *bodies, const struct arc *arc, int count,
                 double *height, double *radius);

// What the bodies have in common when GAP is negative: volume, and the squared radius
// of the circle in which they meet; zeros when they are apart.
struct overlap {
    double volume, radius_squared;
};
struct overlap bodies_overlap(const struct bodies *bodies, double gap);
