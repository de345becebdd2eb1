// SPDX-License-Identifier: GPL-3.0-or-later
// Joints without friction under several loads side by side: as joint.h has it.
#ifndef CRAQUELURE_JOINT_LANES_H
#define CRAQUELURE_JOINT_LANES_H

#include "joint.h"
#include "sparse/supernodal.h"

typedef double lanes __attribute__((vector_size(LANES * sizeof(double)), aligned(8)));

enum { DEGREES = 6, GRAIN = DEGREES * LANES }; // of freedom of a grain; numbers

// By how much the joint is strained where the grains MOVED (n * GRAIN).
void joint_strains_lanes(const struct joint *joint, const double *moved,
                         lanes strain[STRAINS]);
void joint_lengthen_lanes(const struct joint *joint, const double *moved, // the first
                          lanes *strain);

// What the joint resists with when it has been strained by MORE than at the last
// equilibrium, taken off LEFT (n * GRAIN).
void joint_resist_lanes(const struct joint *joint, const lanes more[STRAINS],
                        double *left);

#endif
