// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium where grains move and turn far, found on the geometry as it is.
//
// What is not balanced at the last equilibrium is let in by and by, in increments in
// which no grain moves or turns by more than a given amount. In each, Newton's method
// with what balance.c solves, where directions are as they were at the last factor;
// what is left is measured on the present geometry, and a new factor made, with the
// stiffness that comes of loads turning with joints, when it falls slowly. Where that
// stiffness is no longer positive equilibrium has come to its end: grains buckle or
// snap through, which is dynamics.
#ifndef CRAQUELURE_LARGE_H
#define CRAQUELURE_LARGE_H

#include "equilibrium.h"
#include "large_joint.h"
#include "sparse/anderson.h"

struct large {
    struct lie *start, *before, *now; // (n_joint)
    struct pair_stiffness *more;      // (n_joint) in the factor
    struct anderson acceleration;     // of steps, for what the factor has not
    struct vector *searched;       // (n) shifts when grains near each other were sought
    struct displacement *withheld; // (n) what was not balanced when the way began
    double share;                  // of that let in
    double balanced;               // of the last load
    bool is_least;                 // no smaller increment is tried
    bool is_stale;                 // the factor is not that of the last equilibrium
    bool is_unstable; // the stiffness at the trial was not positive when last factored
};

struct large *large_new(struct equilibrium *equilibrium);
void large_free(struct large *large);

// Strains at the trial, and how joints lie there.
void large_strain_joints(struct equilibrium *equilibrium);
// The load of JOINT on grain END at the trial.
struct displacement large_loads(const struct equilibrium *equilibrium, int joint,
                                int end);
// Joints lie from now on, for the factor and what corrects it, as at the trial.
void large_linearise(struct equilibrium *equilibrium);
// The step that is found becomes the one that is taken.
void large_accelerate(struct equilibrium *equilibrium);
void large_keep_history(struct equilibrium *equilibrium);

// Grains that have come near each other, or the wall, become joints. Whether any of
// these touch at the trial.
bool large_meet(struct equilibrium *equilibrium);

// As approach() and balance() do where displacements are small.
bool large_approach(struct equilibrium *equilibrium);
enum status large_balance(struct equilibrium *equilibrium, struct reason *reason);

#endif
