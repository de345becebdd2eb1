// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium where grains move and turn far, found on the geometry as it is.
//
// What is not balanced at the last equilibrium is let in by and by, in increments in
// which no grain moves or turns by more than a given amount. In each, Newton's method
// with what balance.c solves, where directions are as they were at the last factor;
// what is left is measured on the present geometry, and a new factor made, with the
// stiffness that comes of loads turning with joints, when it falls slowly. Where that
// stiffness is no longer positive equilibrium has come to its end: grains buckle or
// snap through, and dynamics takes them to the next [large_walk.c].
#ifndef CRAQUELURE_LARGE_STATE_H
#define CRAQUELURE_LARGE_STATE_H

#include "pair_frame.h"
#include "quasi_static/quasi_static.h"
#include "sparse/anderson.h"

struct large {
    struct lie *start, *before, *now; // (n_joint)
    struct pair_stiffness *more;      // (n_joint) in the factor
    struct anderson acceleration;     // of steps, for what the factor has not
    struct vector *searched;       // (n) shifts when grains near each other were sought
    struct displacement *withheld; // (n) what was not balanced when the way began
    double share;                  // of that let in
    double balanced;               // so much of this load is
    double ended;                  // so much of a load was balanced at the last snap
    double drag;                   // of dashpots at each grain, besides those at joints
    double tried, most_tried;      // increments and steps in time of this load, and the
                                   // most there may be [large_way.c]
    double hold;      // against motion as one, in the factor [large_free.c]
    bool is_restless; // something did not come to rest under this load
    bool is_stale;    // the factor is not that of the last equilibrium
    bool is_unstable; // the stiffness at the trial was not positive when last factored
};

struct large *large_new(struct equilibrium *equilibrium);
void large_free(struct large *large);

// How stiff the factor has to hold it so that it is positive where the body is stable.
double hold_of(const struct equilibrium *equilibrium);
// As large_softest, by the factor there is [large_mode.c]; its STIFFNESS, which may be
// NULL, without what only the factor holds it with.
int free_softest(struct equilibrium *equilibrium, double *stiffness);
// Whether no motion but as one grows by itself, by the last factor.
bool free_is_stable(struct equilibrium *equilibrium);
// Takes off LEFT (n) what the part of the stiffness that comes of loads turning with
// joints makes of displacements MOVED (n).
void take_off_turning(const struct equilibrium *equilibrium,
                      const struct displacement *moved, struct displacement *left);

// Of a grain since the last equilibrium, at the trial.
struct displacement since_before(const struct equilibrium *equilibrium, int grain);
// Joints lie from now on, for the factor and what corrects it, as at the trial.
void large_linearise(struct equilibrium *equilibrium);

// For as many joints as there are.
void large_make_room(struct equilibrium *equilibrium);

// Grains that have come near each other, or the wall, become joints. Whether any of
// these touch at the trial.
bool large_meet(struct equilibrium *equilibrium);

// To the equilibrium at the share that is let in, if there is a stable one near; with
// DAMPING, a step in time towards it. MOVED, as a share of what an increment may be.
enum advance { ADVANCED, TOO_FAR, MEETS, UNSTABLE, NOT_FOUND };
enum advance large_advance(struct equilibrium *equilibrium, double damping,
                           double *moved);
bool large_approach(struct equilibrium *equilibrium);
enum status large_balance(struct equilibrium *equilibrium, struct reason *reason);

// The grain that moves or turns most in the mode that is resisted least at the last
// equilibrium. A little of that mode then becomes part of it. In steps of time to rest
// under the share that is let in: whether it was reached, bonds that are at their
// strength on the way breaking one a step.
int large_softest(struct equilibrium *equilibrium);
void large_kick(struct equilibrium *equilibrium);
bool large_walk(struct equilibrium *equilibrium, const struct displacement *start);

#endif
