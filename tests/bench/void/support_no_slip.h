// SPDX-License-Identifier: GPL-3.0-or-later
// -laplace of a velocity on a staggered grid that vanishes on spheres.
#pragma once

#include "support_multigrid.h"

// For the velocity along AXIS in the middle of the lower face of each cell of GRID,
// times a cell's volume. Points within spheres are closed, without a leak. Boxes that
// repeat only.
struct level no_slip_level(const struct grid *grid, const struct packing *packing,
                           int axis);
