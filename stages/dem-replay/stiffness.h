// SPDX-License-Identifier: GPL-3.0-or-later
// The sparse stiffness of joints between grains, factored, and what displacements
// answer a load.
#ifndef CRAQUELURE_STIFFNESS_H
#define CRAQUELURE_STIFFNESS_H

#include "joint.h"

struct stiffness;

// For N grains, of which those FIXED (n) do not move, and N_JOINT joints, whose grains
// must stay the same. The caller frees it with stiffness_free.
struct stiffness *stiffness_new(int n, const uint8_t *fixed, int n_joint,
                                const struct joint *joint);
void stiffness_free(struct stiffness *stiffness);

// With TANGENT (n_joint) of each joint, >= 0 for each strain, and SOFT of every grain
// besides. False: it is singular.
bool stiffness_factor(struct stiffness *stiffness, const double (*tangent)[STRAINS],
                      double soft);

// Into ANSWER (n) the displacements under LOAD (n), forces and moments, by the last
// factor; 0 for fixed grains. False: no number came out.
bool stiffness_solve(struct stiffness *stiffness, const struct displacement *load,
                     struct displacement *answer);

// The same under each of the unit loads FIRST, FIRST+1 and FIRST+2 of JOINT, one after
// the other: ANSWER (3 n).
bool stiffness_solve_joint(struct stiffness *stiffness, int joint, int first,
                           struct displacement *answer);

#endif
