// SPDX-License-Identifier: GPL-3.0-or-later
// One increment: to the equilibrium under the present load factor, near the last one.
#pragma once

#include "large_state.h"

enum advance {
    ADVANCED,     // found, stable, and near
    TOO_FAR,      // found, but further away than an increment may lead
    NEW_CONTACTS, // grains touch that were not known to be near each other
    UNSTABLE,     // the tangent is not positive
    NOT_FOUND
};

// From the last equilibrium on; with DAMPING, a step in time. MOVED: over what an
// increment may move.
enum advance advance_increment(struct quasi_static *qs, double damping, double *moved);

// Newton's method, as struct kinematics says.
bool solve_increment(struct quasi_static *qs);
