// SPDX-License-Identifier: GPL-3.0-or-later
// The contact pairs of a packing: its bonds, other grains near each other, and grains
// near the wall beneath.
#pragma once

#include "contact_pair.h"
#include "dem/dem.h"

// What pairs are made from; in SI units but for `rolling`. Made pairs are in units of
// `length` and `stiffness`.
struct contact_pair_setup {
    const struct packing *packing;
    const struct dem_material *material;
    const struct dem_bond_material *bond;
    bool has_wall;
    bool unstressed; // overlaps of the packing do not push
    double rolling;  // contact bonds: stiffness against rolling and twist, of that
                     // against shear times both arms
    double length, stiffness; // units, m and N/m
};

// Grains this far apart, over the sum of their radii or of two mean ones where those
// are larger, are pairs: they may come to touch. Displacements are at most so many mean
// radii; where they may be larger, pairs are sought again.
static const double SEARCH_RANGE = 0.1;

// The contact pair of grains I and J, where J lies SEPARATION (m) from I; of grain I
// and the wall beneath. Without a bond, whatever the packing lists; a contact that
// overlaps sticks, with its shear spring free where it is.
struct contact_pair grain_pair(const struct contact_pair_setup *setup, int i, int j,
                               struct vector separation);
struct contact_pair wall_pair(const struct contact_pair_setup *setup, int i);

// A new array of *COUNT, or NULL for none, that the caller frees: bonds first, in their
// order. Then near grains without a bond, then grains near the wall: the order fixes
// that of all sums.
struct contact_pair *make_contact_pairs(const struct contact_pair_setup *setup,
                                        int *count);
