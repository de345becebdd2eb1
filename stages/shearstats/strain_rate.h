// SPDX-License-Identifier: GPL-3.0-or-later
// The strain rate of the coarse velocity.
#pragma once

#include "field_kinds.h"
#include "grid.h"

// RATE (3, 3), 1/s, in a filled CELL, from velocities and angular velocities of FIELDS.
// The symmetric part of the gradient, row-major, in the components of the grid.
// Elongation is positive, unlike stress. FIELDS must have its velocities in the cells
// beside CELL, too.
void strain_rate(const struct grid *grid, const struct fields *fields, int cell,
                 double rate[9]);
