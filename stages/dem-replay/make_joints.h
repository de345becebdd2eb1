// SPDX-License-Identifier: GPL-3.0-or-later
// The joints of a packing: its bonds, other grains near each other, and grains near the
// wall beneath.
#ifndef CRAQUELURE_MAKE_JOINTS_H
#define CRAQUELURE_MAKE_JOINTS_H

#include "dem/dem.h"
#include "joint.h"

struct joint_setup {
    const struct packing *packing;
    const struct dem_material *material;
    const struct dem_bond_material *bond;
    bool has_wall;
    bool unstressed; // overlaps of the packing do not push
    double rolling;  // contact bonds: stiffness against rolling and twist, of that
                    // against shear times both arms
    double length, stiffness; // units, m and N/m
};

// A new array of *COUNT, or NULL for none, that the caller frees: bonds first, in their
// order.
struct joint *make_joints(const struct joint_setup *setup, int *count);

#endif
