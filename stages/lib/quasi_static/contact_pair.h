// SPDX-License-Identifier: GPL-3.0-or-later
// Two grains that are bonded or may touch, or a grain and the wall beneath, for small
// displacements about where they began. A joint answers six strains with six loads,
// each of its own but for slip, which ties both shears to the normal force.
#ifndef CRAQUELURE_CONTACT_PAIR_H
#define CRAQUELURE_CONTACT_PAIR_H

#include "displacement.h"

#include <stdbool.h>
#include <stdint.h>

enum strain { STRAIN_ALONG, STRAIN_ACROSS, STRAIN_TWIST = 3, STRAIN_BEND, STRAINS = 6 };

enum touch {
    TOUCH_NONE,
    TOUCH_STICKS,
    TOUCH_SLIPS,
    TOUCH_BEGINS // since the last equilibrium: no shear yet
};

struct contact {
    enum touch touch;
    double anchor[2]; // shear strains at which the shear spring is free
};

struct joint {
    int32_t grain[2];      // the second is -1 for the wall
    int32_t bond;          // as numbered in the packing, or -1
    bool is_bonded;        // and has not broken
    bool is_gone;          // one of the grains has left the aggregate
    struct vector axis[3]; // from the first to the second, and two across it
    double arm[2];         // from the centres to the contact point
    double overlap;        // at the start
    double bond_radius;
    double moments_left_out; // of its stresses: 1 - beta (dem_bond_material)
    // Parallel bond [K 4.32-4.39]: k^n A, k^s A twice, k^s J, k^n I twice. Point of
    // glue, a contact bond [K 4.2]: the contact's springs, also in tension; what is in
    // contact when it breaks is OVERLAP from then on.
    double bond_stiffness[STRAINS];
    bool is_point;
    double point_overlap;                 // at the start; parallel bonds: 0
    double contact_along, contact_across; // [K 4.22]; no shear without friction
    double friction;
    // Of the last equilibrium, from which history goes on.
    double strain[STRAINS];
    struct contact contact;
};

// What a joint resists with, and how that changes with the strains.
struct resistance {
    double load[STRAINS];
    double slope[3][3]; // of the first three loads with the first three strains
    double stiffness[STRAINS - 3]; // of the others, each with its own
    struct contact contact;        // as it would be
};

// Strains of [K 4.7, 4.15, 4.17], all linear, when the grains move so; NULL: one that
// does not, as the wall.
void joint_strains(const struct joint *joint, const struct displacement *first,
                   const struct displacement *second, double strain[STRAINS]);
struct resistance joint_resistance(const struct joint *joint,
                                   const double strain[STRAINS]);

// The same while Newton's method looks for a solution: whether a contact slips, and
// which way, is judged as if its springs had SHARE of their stiffness (at most 1, as
// they are), the one across had pulled with PULL before and the grains had overlapped
// by OVERLAP. A solution is the same [Alart and Curnier 1991]; on the way strains much
// larger than the springs' own tell less.
struct judgement {
    double share, pull[2], overlap;
};
struct resistance joint_softened(const struct joint *joint,
                                 const double strain[STRAINS],
                                 const struct judgement *judgement);

// What of STRAIN a displacement of the grain at END makes: the transpose is what the
// load does to that grain.
struct displacement joint_arm(const struct joint *joint, int end, int strain);

// The force and moment on grain END that LOADS, from strains as they are, resist with:
// what is to be added to the load when the grain is pushed the way of its displacement.
struct displacement joint_loads(const struct joint *joint, int end,
                                const double load[STRAINS]);

// Takes those off LEFT (n) of both grains.
void joint_take_off(const struct joint *joint, const double load[STRAINS],
                    struct displacement *left);

// Stress over strength [K 4.41, 4.42] of an intact bond at STRAIN, of a point force.
struct overload {
    double normal, shear;
};
struct overload joint_overload(const struct joint *joint, const double strain[STRAINS],
                               double normal_strength, double shear_strength);

// What is left is a contact, if grains touch at STRAIN with the shear there is.
void joint_break(struct joint *joint, const double strain[STRAINS]);

#endif
