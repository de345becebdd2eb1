// SPDX-License-Identifier: GPL-3.0-or-later
// With v the velocity and w the angular velocity, of which nothing depends on the
// angle:
//     Cartesian  d_ab = (dv_a/db + dv_b/da) / 2
//     cylinder   d_rr = dv_r/dr,  d_zz = dv_z/dz,  d_aa = v_r / r,
//                d_rz = (dv_r/dz + dv_z/dr) / 2,
//                d_ra = r/2 dw/dr,  d_az = r/2 dw/dz      (a: the angle)
// so that a rigid rotation strains nothing. Derivatives are differences between the
// cells on both sides (error: spacing squared), or to the only one that has grains
// (error: spacing); along an axis of one cell they are 0.
#include "strain_rate.h"

// Derivative along AXIS of column COLUMN. `steps` is 2 with a neighbour on both sides,
// 1 at an edge; a missing side is replaced by the cell itself.
static double derivative(const struct grid *grid, const struct fields *fields, int cell,
                         int axis, int column)
{
    const size_t width = (size_t)fields_width();
    if (grid->axis[axis].n == 1) return 0;
    int end[2], steps = 0;
    for (int side = 0; side < 2; side++) {
        const int beside = cell_beside(grid, cell, axis, 2 * side - 1);
        const bool there = beside >= 0 && fields->filled[beside];
        end[side] = there ? beside : cell;
        steps += there;
    }
    if (steps == 0) return 0;
    const double rise = fields->value[(size_t)end[1] * width + (size_t)column] -
                        fields->value[(size_t)end[0] * width + (size_t)column];
    return rise / (steps * grid->axis[axis].spacing);
}

// The angular component of the gradient is r dw/dr, not dv/dr: that is what makes a
// rigid rotation cancel to the last digit. cell_centre is never 0.
void strain_rate(const struct grid *grid, const struct fields *fields, int cell,
                 double rate[9])
{
    const int v = field_column(FIELD_VELOCITY),
              w = field_column(FIELD_ANGULAR_VELOCITY);
    double gradient[3][3]; // of component a along b
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            gradient[a][b] = derivative(grid, fields, cell, b, v + a);
    if (grid->cylindrical) {
        const double r = cell_centre(grid, cell, 0);
        gradient[1][0] = r * derivative(grid, fields, cell, 0, w);
        gradient[1][2] = r * derivative(grid, fields, cell, 2, w);
        gradient[1][1] = field_at(fields, cell, FIELD_VELOCITY)[0] / r;
    }
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            rate[3 * a + b] = 0.5 * (gradient[a][b] + gradient[b][a]);
}
