// SPDX-License-Identifier: GPL-3.0-or-later
// A contact pair: two grains that are bonded or may touch, or a grain and the wall
// beneath, for small displacements about where they began.
//
// Its deformation is the displacement and rotation of the second grain relative to the
// first at the contact: six components, in axes of the pair. Each is answered by a load
// of its own (normal force, two shear forces, torsion, two bending moments), but for
// slip, which ties both shear forces to the normal force.
//
// With n, t1, t2 the axes, x and w translations and rotations, a the arms [K 4.7, 4.15,
// 4.17]:
//     d[NORMAL]  = n . (x_j - x_i)            > 0 where the grains part
//     d[SHEAR], d[SHEAR + 1]                  along t1, t2, of the contact point
//     d[TORSION], d[BENDING], d[BENDING + 1]  = n, t1, t2 . (w_j - w_i)
// In short d = B u, and what resists acts on the grains as -B^T load. All functions are
// pure but those that say which array they change.
#pragma once

#include "displacement.h"

#include <stdbool.h>
#include <stdint.h>

// Shear and bending have two components each, one after the other: SHEAR + 1 and
// BENDING + 1.
enum component { NORMAL, SHEAR, TORSION = 3, BENDING, COMPONENTS = 6 };

enum contact_state {
    CONTACT_OPEN,
    CONTACT_STICKING,
    CONTACT_SLIPPING,
    CONTACT_NEW // closed since the last equilibrium: no shear force yet
};

// Its shear force is shear_stiffness times (deformation - anchor): slip moves the
// anchor, so that the history is two numbers.
struct contact {
    enum contact_state state;
    double anchor[2]; // shear deformation at which the shear spring is free
};

// In the units of the engine (displacement.h). All but the last block is set when the
// pair is made and changes only as a bond breaks.
struct contact_pair {
    int32_t grain[2];      // the second is -1 for the wall
    int32_t bond;          // as numbered in the packing, or -1
    bool is_bonded;        // and the bond has not broken
    bool is_detached;      // one of the grains has left the aggregate
    struct vector axis[3]; // normal, from the first to the second, and two tangents
    double arm[2];         // from the centres to the contact point
    double overlap;        // at the start
    double bond_radius;
    double moments_left_out; // of its stresses: 1 - beta (dem_bond_material)
    // Parallel bond [K 4.32-4.39]: k^n A, k^s A twice, k^s J, k^n I twice. Contact bond
    // (IS POINT) [K 4.2]: the springs of the contact, also in tension; when it breaks,
    // FREE STRETCH becomes the OVERLAP of the contact.
    double bond_stiffness[COMPONENTS];
    bool is_point;
    double
        free_stretch; // deformation[NORMAL] without tension in the bond: of a contact
                      // bond the overlap at the start, else 0; less as grains shrink
    double normal_stiffness, shear_stiffness; // of the contact [K 4.22]; no shear
                                              // without friction
    double friction;
    // At the last equilibrium, from which history goes on.
    double deformation[COMPONENTS];
    struct contact contact;
};

// The loads with which a pair resists, and their derivatives. SLOPE is not symmetric
// where the contact slips: shear forces follow the normal force, not the other way
// round.
struct pair_response {
    double load[COMPONENTS];
    double slope[3][3]; // of the three forces with the first three components
    double stiffness[COMPONENTS - 3]; // of each moment with its own component
    struct contact contact;           // as it would be
};

// The deformation [K 4.7, 4.15, 4.17], linear in the displacements of the FIRST and the
// SECOND grain; NULL: one that does not move, as the wall.
void pair_deformation(const struct contact_pair *pair, const struct displacement *first,
                      const struct displacement *second,
                      double deformation[COMPONENTS]);

// The law of contact and bond at DEFORMATION [K 4.11-4.26, 4.31-4.39].
struct pair_response pair_respond(const struct contact_pair *pair,
                                  const double deformation[COMPONENTS]);

// The same as the augmented Lagrangian of Alart and Curnier (1991) has it while
// Newton's method iterates: whether and which way a contact slips is judged by springs
// of STIFFNESS RATIO (0 to 1) of their stiffness, which carried SHEAR FORCE and had the
// OVERLAP before. A solution is the same; on the way there, increments that are far too
// large for the contact's own springs do less harm.
struct augmented_state {
    double stiffness_ratio, shear_force[2], overlap;
};
struct pair_response pair_respond_augmented(const struct contact_pair *pair,
                                            const double deformation[COMPONENTS],
                                            const struct augmented_state *augmented);

// The six numbers of B by which the displacement of the grain at END makes COMPONENT of
// the deformation; and so, transposed, what a load of that component does to the grain.
struct displacement pair_kinematic_row(const struct contact_pair *pair, int end,
                                       int component);

// B^T LOAD on the grain at END: force and moment with which the pair resists.
struct displacement pair_load_on_grain(const struct contact_pair *pair, int end,
                                       const double load[COMPONENTS]);

// Subtracts those of both grains from RESIDUAL (n). On the second grain of a pair with
// the wall nothing acts.
void pair_subtract_load(const struct contact_pair *pair, const double load[COMPONENTS],
                        struct displacement *residual);

// Stress over strength of an intact bond at DEFORMATION [K 4.41, 4.42]; of a contact
// bond, force over strength. 1 breaks it (FAILURE_THRESHOLD leaves room for rounding).
struct overload {
    double normal, shear;
};
struct overload pair_overload(const struct contact_pair *pair,
                              const double deformation[COMPONENTS],
                              double normal_strength, double shear_strength);

// A contact stays, where grains touch at DEFORMATION, with the shear that there is.
void pair_break_bond(struct contact_pair *pair, const double deformation[COMPONENTS]);
