// SPDX-License-Identifier: GPL-3.0-or-later
// Inside struct quasi_static where displacements are large.
//
// The residual at the last equilibrium, r0, is applied gradually: under a load factor s
// Newton's method looks for residual = (1 - s) r0 on the geometry as it is, by
// increments in which no grain moves or turns by more than a given amount
// [load_stepping.c, increment.c]. Where the tangent is no longer positive, equilibrium
// is at a limit point: grains buckle or snap through, and dynamics follows them to the
// next equilibrium [implicit_dynamics.c].
#pragma once

#include "pair_frame.h"
#include "quasi_static/quasi_static_internal.h"
#include "sparse/anderson.h"

struct large_state {
    struct pair_frame *start, *previous, *current; // (n_pair)
    struct pair_stiffness *geometric;              // (n_pair) in the factor
    struct anderson acceleration; // of steps, for what the factor has not
    struct vector *searched_at;   // (n) translations when contacts were sought
    struct displacement *residual_at_start; // (n) r0
    double load_factor;                     // s
    double balanced_fraction;               // so much of this load is balanced
    double fraction_at_instability;         // so much was at the last instability
    double mass_damping;  // of dashpots at each grain, besides those at pairs
    double work_spent;    // increments and steps in time of this load
    double work_limit;    // on these
    double stabilisation; // of K against rigid rotation [stabilisation.c]
    bool is_unconverged;  // something did not come to rest under this load
    bool factor_is_stale; // it is not that of the last equilibrium
    bool is_unstable;     // the tangent of the iterate was not positive
};

struct large_state *large_state_create(struct quasi_static *qs);
void large_state_free(struct large_state *large);

// All arrays (n_pair), with what they hold, for the pairs that there are.
void large_state_allocate_pairs(struct quasi_static *qs);

// The displacement of GRAIN from the last equilibrium to the iterate.
struct displacement displacement_since_previous(const struct quasi_static *qs,
                                                int grain);

// The frames and the geometric stiffness of the pairs become those of the iterate.
void large_linearise(struct quasi_static *qs);
