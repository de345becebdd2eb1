// SPDX-License-Identifier: GPL-3.0-or-later
// What the factor of a body that nothing holds needs to be positive where the body is
// stable.
#pragma once

#include "large_state.h"

// A stiffness on the diagonal, in the units of K, for the geometric stiffness as last
// found [large_linearise]: twice a bound on what that resists rigid rotation with, and
// a little more.
double find_stabilisation(const struct quasi_static *qs);

// Subtracts from RESIDUAL (n) the geometric stiffness of all pairs times MOVED (n).
void subtract_geometric_load(const struct quasi_static *qs,
                             const struct displacement *moved,
                             struct displacement *residual);
