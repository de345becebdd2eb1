// SPDX-License-Identifier: GPL-3.0-or-later
// Least squares for [G 14] over the cells that flow, each counting once,
//     shear stress = friction pressure + cohesion,
// with errors from the mean square residual over n - 2.
//
// Pressure and shear stress are invariants (fields.c). The errors take pressures as
// exact and cells as independent; neighbours within the kernel are not, which makes
// these errors too small. Block errors and the interval over runs do not suffer from
// that.
#include "rheology.h"

#include "basics/memory.h"

#include <gsl/gsl_fit.h>
#include <math.h>
#include <stdlib.h>

bool is_flowing(const struct grid *grid, const struct fields *fields, int cell,
                const struct flowing *flowing)
{
    if (!fields->filled[cell]) return false;
    if (!(*field_at(fields, cell, FIELD_SHEAR_RATE) > flowing->least_rate))
        return false;
    if (*field_at(fields, cell, FIELD_FRACTION) < flowing->least_fraction) return false;
    for (int axis = 0; axis < 3; axis++) {
        const double at = cell_centre(grid, cell, axis);
        if (grid->axis[axis].everywhere) continue;
        if (at < flowing->lower[axis] || at > flowing->upper[axis]) return false;
    }
    return true;
}

// A line needs two points, its errors a third.
struct line_fit fit_line(const double *pressure, const double *stress, int n)
{
    struct line_fit fit = {.n = n};
    if (n < 3) return fit;
    double c00, c01, c11, squares;
    gsl_fit_linear(pressure, 1, stress, 1, (size_t)n, &fit.cohesion, &fit.friction,
                   &c00, &c01, &c11, &squares);
    fit.cohesion_error = sqrt(c00);
    fit.friction_error = sqrt(c11);
    fit.residual = sqrt(squares / n);
    if (!isfinite(fit.friction) || !isfinite(fit.friction_error)) // all of one pressure
        fit = (struct line_fit){0};
    return fit;
}

struct line_fit fit_rheology(const struct grid *grid, const struct fields *fields,
                             const struct flowing *flowing)
{
    const int n_cell = grid_cells(grid);
    double *pressure = NEW_ARRAY(double, n_cell), *stress = NEW_ARRAY(double, n_cell);
    int n = 0;
    for (int cell = 0; cell < n_cell; cell++) {
        if (!is_flowing(grid, fields, cell, flowing)) continue;
        pressure[n] = *field_at(fields, cell, FIELD_PRESSURE);
        stress[n++] = *field_at(fields, cell, FIELD_SHEAR_STRESS);
    }
    const struct line_fit fit = fit_line(pressure, stress, n);
    free(pressure);
    free(stress);
    return fit;
}
