// SPDX-License-Identifier: GPL-3.0-or-later
// How fast moving grains and walls open and close the pores [C 5, 20].
#pragma once

#include "throats.h"

// Rate at which the fluid volume of each pore grows, (n_pore) unit^3 a unit of time:
// what its facets sweep, less what they sweep of the grains. The exact derivative of
// the volume of the cells less the grains' sectors in them, as long as the
// triangulation stays; over all pores it sums to the rate of the box. VELOCITY
// (n_base), of the grains from the lower corner, which stands still; RATE: strain rate
// of the box along each axis. The caller frees it.
double *opening_rates(const struct grains *grains, const struct cells *cells,
                      const struct throats *throats, const struct vector *velocity,
                      struct vector rate);
