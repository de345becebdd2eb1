// SPDX-License-Identifier: GPL-3.0-or-later
// The drag on small grains that float in a pore.
#ifndef CRAQUELURE_FLOW_SMALL_GRAINS_H
#define CRAQUELURE_FLOW_SMALL_GRAINS_H

#include "forces.h"

// [C 18] drags a grain by its share of the surface, which falls faster with its size
// than Stokes' 6 pi mu a u does. Here each grain gets the root of the sum of the
// squares of both, with u twice the mean velocity of the fluid around it, as in the
// middle of a pipe. What it gets more is taken from the grains and walls around it, by
// their surfaces, so that all forces sum to what they did. In dense packings Stokes'
// part is lost in the other.
void add_stokes_drag(const struct grains *grains, const struct cells *cells,
                     const struct throats *throats, const struct pressures *pressures,
                     struct forces *forces);

#endif
