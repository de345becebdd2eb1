// SPDX-License-Identifier: GPL-3.0-or-later
// A point q spread by the kernel phi of half width h has in the interval [a, b] the
// share
//     Phi((b - q) / h) - Phi((a - q) / h),   Phi the integral of phi,
// and in a cell the product over the axes: means over cells of the fields of Goldhirsch
// (2010), not their values at points. Over all cells the differences cancel, so that
// nothing is lost: the sum over the grid is what the points had.
//
// Next to the axis of a cylinder, what would lie at r < 0 lies at -r. A cell there has
// the volume pi (b^2 - a^2) dz.
#include "grid.h"

#include "kernel.h"

#include <math.h>

int grid_cells(const struct grid *grid)
{
    return grid->axis[0].n * grid->axis[1].n * grid->axis[2].n;
}

static int stride_of(const struct grid *grid, int axis)
{
    return axis == 2   ? 1
           : axis == 1 ? grid->axis[2].n
                       : grid->axis[2].n * grid->axis[1].n;
}

static int cell_place(const struct grid *grid, int cell, int axis)
{
    return cell / stride_of(grid, axis) % grid->axis[axis].n;
}

// STEP is 1 or -1.
int cell_beside(const struct grid *grid, int cell, int axis, int step)
{
    const struct grid_axis *along = &grid->axis[axis];
    const int here = cell_place(grid, cell, axis);
    int there = here + step;
    if (along->repeats) there = (there + along->n) % along->n;
    if (there < 0 || there >= along->n) return -1;
    return cell + (there - here) * stride_of(grid, axis);
}

static double edge(const struct grid_axis *axis, int interval)
{
    return axis->lower + interval * axis->spacing;
}

double cell_centre(const struct grid *grid, int cell, int axis)
{
    const struct grid_axis *along = &grid->axis[axis];
    const int place = cell_place(grid, cell, axis);
    return 0.5 * (edge(along, place) + edge(along, place + 1));
}

// The angle's interval is all of it, 2 pi long, so that spacing_r 2 pi spacing_z r is
// pi (b^2 - a^2) dz: r is the middle of a and b.
double cell_volume(const struct grid *grid, int cell)
{
    double volume = 1;
    for (int axis = 0; axis < 3; axis++)
        volume *= grid->axis[axis].spacing;
    return grid->cylindrical ? volume * cell_centre(grid, cell, 0) : volume;
}

// -1 is the mirror of 0, not of 1: interval k of a reflected axis begins at k spacing.
// Modulo twice, because C's remainder of a negative number is not positive.
static void add_share(const struct grid_axis *axis, int interval, double share,
                      struct shares *shares)
{
    if (axis->repeats) interval = (interval % axis->n + axis->n) % axis->n;
    if (axis->reflects && interval < 0) interval = -1 - interval;
    if (interval < 0 || interval >= axis->n || shares->n == MOST_SHARES) return;
    shares->interval[shares->n] = interval;
    shares->share[shares->n++] = share;
}

// The last interval gets what is left up to 1, so that rounding of the kernel's
// integral cannot lose mass.
// Shares sum to 1 to rounding where the kernel lies within the axis, or it repeats. AT
// in m. A point whose kernel sticks out of the axis loses what falls outside; one far
// outside has no shares.
static void find_shares(const struct grid_axis *axis, double at, struct shares *shares)
{
    shares->n = 0;
    if (axis->everywhere) {
        add_share(axis, 0, 1, shares);
        return;
    }
    const double place = (at - axis->lower) / axis->spacing;
    const double reach = axis->half_width / axis->spacing;
    if (!(fabs(place) < 1e9)) return; // far outside
    const int first = (int)floor(place - reach), last = (int)floor(place + reach);
    if (!(reach > 0)) {
        const double upper = axis->lower + axis->n * axis->spacing;
        const bool beside = (at < axis->lower && axis->lower - at <= axis->slack[0]) ||
                            (at >= upper && at - upper <= axis->slack[1]);
        add_share(axis, beside && axis->n == 1 ? 0 : first, 1, shares);
        return;
    }
    double below = 0;
    for (int k = first; k <= last; k++) {
        const double up_to = k == last ? 1 : kernel_share((k + 1 - place) / reach);
        add_share(axis, k, up_to - below, shares);
        below = up_to;
    }
}

void spread(const struct grid *grid, const double at[3], const double *value,
            size_t count, double *sum, size_t stride)
{
    struct shares along[3];
    for (int axis = 0; axis < 3; axis++)
        find_shares(&grid->axis[axis], at[axis], &along[axis]);
    for (int a = 0; a < along[0].n; a++)
        for (int b = 0; b < along[1].n; b++)
            for (int c = 0; c < along[2].n; c++) {
                const double share =
                    along[0].share[a] * along[1].share[b] * along[2].share[c];
                const int cell =
                    (along[0].interval[a] * grid->axis[1].n + along[1].interval[b]) *
                        grid->axis[2].n +
                    along[2].interval[c];
                double *row = sum + (size_t)cell * stride;
                for (size_t k = 0; k < count; k++)
                    row[k] += share * value[k];
            }
}
