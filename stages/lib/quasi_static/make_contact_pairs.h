// SPDX-License-Identifier: GPL-3.0-or-later
// The joints of a packing: its bonds, other grains near each other, and grains near the
// wall beneath.
#ifndef CRAQUELURE_MAKE_CONTACT_PAIRS_H
#define CRAQUELURE_MAKE_CONTACT_PAIRS_H

#include "dem/dem.h"
#include "contact_pair.h"

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

// Grains this far apart, of the sum of their radii, may come to touch: what is left of
// the aggregate moves less, or they are looked for again.
static const double joint_reach = 0.1;

// Of grains I and J, which lie SEPARATION apart, m; of grain I and the wall beneath.
struct joint contact_joint(const struct joint_setup *setup, int i, int j,
                           struct vector separation);
struct joint wall_joint(const struct joint_setup *setup, int i);

// A new array of *COUNT, or NULL for none, that the caller frees: bonds first, in their
// order.
struct joint *make_joints(const struct joint_setup *setup, int *count);

#endif
