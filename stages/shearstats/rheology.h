// SPDX-License-Identifier: GPL-3.0-or-later
// Shear stress against pressure where the material flows [G 14]. Grains that hardly
// move have a shear stress below the yield stress, so only cells that flow lie on the
// line.
#pragma once

#include "field_kinds.h"
#include "grid.h"

#include <stdbool.h>

// Which cells count. LOWER and UPPER keep cells away from the walls, where the kernel
// sees only part of the contacts; axes of one interval are not bounded.
struct flowing {
    double least_rate;         // shear rate must be above this, 1/s
    double least_fraction;     // of solid
    double lower[3], upper[3]; // within these coordinates, m
};

// Shear rate and solid fraction are those of FIELDS, which may be of one run or one
// block.
bool is_flowing(const struct grid *grid, const struct fields *fields, int cell,
                const struct flowing *flowing);

// The line; standard errors are those of independent scatter around it.
struct line_fit {
    int n;                           // points; below 3: no fit, and the rest is 0
    double friction, friction_error; // slope
    double cohesion, cohesion_error; // at 0, Pa
    double residual;                 // root mean square, Pa
};
// PRESSURE and STRESS (n), Pa. If all pressures are equal there is no line, and N is 0.
// fit_rheology takes the flowing cells of FIELDS.
struct line_fit fit_line(const double *pressure, const double *stress, int n);
struct line_fit fit_rheology(const struct grid *grid, const struct fields *fields,
                             const struct flowing *flowing);
