// SPDX-License-Identifier: GPL-3.0-or-later
// Joints without friction under several loads side by side: as joint.h has it.
#ifndef CRAQUELURE_JOINT_LANES_H
#define CRAQUELURE_JOINT_LANES_H

#include "basics/wide_vectors.h"
#include "joint.h"
#include "sparse/supernodal.h"

enum { DEGREES = 6, GRAIN = DEGREES * LANES }; // of freedom of a grain; numbers

struct bond_strength {
    double normal, shear;
    const double *relative; // (n_bond) of those; NULL: 1
};

// What joints and grains say of each lane. What is not a number is in the sums.
struct lane_sums {
    double carried[LANES],
        carrying[LANES];      // forces of joints; those that carry or hold
    double overload[LANES];   // of bonds, the largest
    double unbalanced[LANES]; // sum of the forces left on grains
    double left[LANES];       // largest force or moment left
    double furthest[LANES];   // largest displacement since the beginning
};

struct lane_kernels {
    // In which lanes each of N_JOINT joints touches, a bit for each (n_joint), where
    // the grains MOVED (n * GRAIN) since strains were those FROM (n_joint).
    void (*touch)(int n_joint, const struct joint *joint, const double (*from)[STRAINS],
                  const double *moved, uint8_t *touches);
    // Takes what they resist with there off LEFT (n * GRAIN).
    void (*resist)(int n_joint, const struct joint *joint,
                   const double (*from)[STRAINS], const struct bond_strength *strength,
                   const double *moved, double *left, struct lane_sums *sums);
    // What grain GRAIN has LEFT, and where it is, FROM where it was.
    void (*measure)(int grain, const struct displacement *from, const double *moved,
                    const double *left, struct lane_sums *sums);
};
extern const struct lane_kernels lane_kernels_narrow, lane_kernels_wide;

static inline const struct lane_kernels *lane_kernels(void)
{
    return has_wide_vectors() ? &lane_kernels_wide : &lane_kernels_narrow;
}

#endif
