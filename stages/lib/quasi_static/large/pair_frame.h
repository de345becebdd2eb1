// SPDX-License-Identifier: GPL-3.0-or-later
// Deformation and geometric stiffness of a pair whose grains move and turn far: a frame
// that turns with the pair, as the discrete elements have it [K 4.13-4.17], followed
// from one equilibrium to the next.
#pragma once

#include "quasi_static/contact_pair.h"

// Axes and arms, as in struct contact_pair.
struct pair_frame {
    struct vector axis[3];
    double arm[2];
};

// The axes and arms that PAIR has now; set_frame gives it others.
struct pair_frame frame_of(const struct contact_pair *pair);
void set_frame(struct contact_pair *pair, const struct pair_frame *frame);

// Frames of the pair at the start and at the last equilibrium (its deformation then is
// the pair's), the translation of the second grain less that of the first since the
// start, and the displacements of both since the last equilibrium; NULL: one that does
// not move, as the wall.
struct pair_motion {
    const struct pair_frame *start, *previous;
    struct vector translation;
    const struct displacement *by[2];
};

// Into DEFORMATION and the frame CURRENT. The error falls with the square of the
// motion since the last equilibrium, but what the grains come closer is exact.
void large_deformation(const struct contact_pair *pair,
                       const struct pair_motion *motion, double deformation[COMPONENTS],
                       struct pair_frame *current);

// What LOAD, as it turns with the pair, adds to the tangent B^T k B: forces and moments
// on both grains, six rows each, with the translations and rotations of both. Only its
// symmetric part: shear over arms of changing length has another, of the size of the
// shear force, which is left to the iteration.
struct pair_stiffness {
    double block[12][12];
};
void geometric_stiffness(const struct contact_pair *pair,
                         const struct pair_frame *frame, const double load[COMPONENTS],
                         struct pair_stiffness *stiffness);
