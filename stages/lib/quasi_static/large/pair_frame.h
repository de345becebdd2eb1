// SPDX-License-Identifier: GPL-3.0-or-later
// Strains and stiffness of a joint whose grains move and turn far: as the discrete
// elements follow them [K 4.13-4.17], from one equilibrium to the next. The normal
// turns with the centres, the axes across it besides with the mean of the two grains;
// shear, twist and bending are added up in these axes, by the midpoint rule, whose
// error falls with the square of the increment. What the grains come closer is exact.
#ifndef CRAQUELURE_PAIR_FRAME_H
#define CRAQUELURE_PAIR_FRAME_H

#include "quasi_static/contact_pair.h"

// How a joint lies.
struct lie {
    struct vector axis[3]; // as of struct joint
    double arm[2];
};

struct lie joint_lie(const struct joint *joint);
void lay_joint(struct joint *joint, const struct lie *lie);

// Where a joint began, how it lay at the last equilibrium (its strains then are the
// joint's), and how its grains have moved since the start (SHIFT) and since then (BY).
// NULL in BY: one that does not move, as the wall.
struct passage {
    const struct lie *start, *before;
    struct vector shift; // of the second grain less that of the first
    const struct displacement *by[2];
};
void large_strains(const struct joint *joint, const struct passage *passage,
                   double strain[STRAINS], struct lie *now);

// How the forces and moments on both grains, six rows each, change with their shifts
// and turns when LOAD turns with the joint as it lies: what comes to B^T k B. Its
// symmetric part: shear over arms of changing length has another, of the size of the
// shear force, which is left to the iteration.
struct pair_stiffness {
    double block[12][12];
};
void geometric_stiffness(const struct joint *joint, const struct lie *lie,
                         const double load[STRAINS], struct pair_stiffness *stiffness);

#endif
