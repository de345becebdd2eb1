// SPDX-License-Identifier: GPL-3.0-or-later
// Overdamped dynamics where equilibrium ends: dashpots at all pairs, in proportion to
// their stiffness, slow the way to the next equilibrium.
#pragma once

#include "large_state.h"

// A little of the mode in `step` becomes part of the last equilibrium.
void perturb_along_mode(struct quasi_static *qs);

// Steps in time to rest under the present load factor; bonds that are at their strength
// on the way break, one a step, and fragments that nothing holds leave when they are
// far from START (n). False: no rest.
bool follow_dynamics(struct quasi_static *qs, const struct displacement *start);
