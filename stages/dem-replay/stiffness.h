// SPDX-License-Identifier: GPL-3.0-or-later
// The sparse stiffness of joints between grains, and what displacements answer a load.
//
// A factor is kept while joints change: conjugate gradients, with the old factor before
// them, need about as many steps as the change has ranks (a broken bond: six), each
// much cheaper than a new factor, which is made when that takes too many.
#ifndef CRAQUELURE_STIFFNESS_H
#define CRAQUELURE_STIFFNESS_H

#include "joint.h"

struct stiffness;

// For N grains, of which those FIXED (n) do not move, and N_JOINT joints, whose grains
// must stay the same. The caller frees it with stiffness_free.
struct stiffness *stiffness_new(int n, const uint8_t *fixed, int n_joint,
                                const struct joint *joint);
void stiffness_free(struct stiffness *stiffness);

// Into ANSWER (n) the displacements under LOAD (n), forces and moments, when joints
// resist with the tangents of RESISTANCE (n_joint), and every grain with SOFT besides;
// to a thousandth of the load or better. 0 for fixed grains. False: no number came out.
bool stiffness_solve(struct stiffness *stiffness, const struct resistance *resistance,
                     double soft, const struct displacement *load,
                     struct displacement *answer);

#endif
