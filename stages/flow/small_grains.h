// SPDX-License-Identifier: GPL-3.0-or-later
// The drag on small grains in a large pore.
#pragma once

#include "forces.h"

// [C 18] drags a grain in proportion to its surface, R^2, and so too little when it is
// small: Stokes' drag, 6 pi mu R u, is of the order of R. Here each grain gets the root
// of the sum of squares of both, with u twice the mean velocity of the fluid around it,
// as in the middle of a pipe. The difference is taken from the grains and walls around
// it, by their surfaces, so that the sum of all forces stays. In dense packings Stokes'
// part is negligible. FORCES must be those of find_forces for the same PRESSURES;
// viscous parts change.
void add_stokes_drag(const struct grains *grains, const struct cells *cells,
                     const struct throats *throats, const struct pressures *pressures,
                     struct forces *forces);
