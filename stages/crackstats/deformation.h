// SPDX-License-Identifier: GPL-3.0-or-later
// How the body as a whole has changed its shape [K 5.10]: shrinkage and spring-back.
#pragma once

#include "run.h"

enum { STRAIN_COUNT = 6 }; // xx, yy, zz, yz, xz, xy

struct deformation {
    double shrinkage;            // of the volume: 1 - det(1 + G)
    double strain[STRAIN_COUNT]; // of small displacements: (G + G^T) / 2
};

// Deformation of the largest fragment at snapshot S. G is the displacement gradient
// that fits its grains best by least squares, across the sides of a box that repeats
// too; 0 along an axis in which all lie in one plane, or along which it leads around
// the box. All NAN when it has fewer than four grains.
struct deformation body_deformation(const struct run *run, int s);
