// SPDX-License-Identifier: GPL-3.0-or-later
// At the height z between the middles of two layers of cells, sums are interpolated,
//     turned = sum m r v_angle / (sum m r^2 rate),
// or 1 minus that where the inner part turns, so that it rises outwards as [G 13].
//
// Both sums are interpolated before the quotient is taken. The quotient of each layer,
// interpolated, would give a layer with one grain the weight of a full one.
//
// Angular velocities, not velocities over r: in a rigid rotation m r v_angle and m r^2
// rate are proportional grain by grain, so that `turned` is 1 however wide cells and
// kernel are.
#include "band.h"

#include "basics/memory.h"
#include "sums.h"

#include <math.h>
#include <stdlib.h>

// The two layers beside HEIGHT, and the share of the upper one. Below the middle of the
// lowest layer, and above that of the highest, the profile is that of the layer.
static double layers_beside(const struct grid_axis *axis, double height, int layer[2])
{
    const double place = (height - axis->lower) / axis->spacing - 0.5;
    const double inside = fmin(fmax(place, 0), axis->n - 1);
    layer[0] = (int)floor(inside);
    layer[1] = layer[0] + 1 < axis->n ? layer[0] + 1 : layer[0];
    return inside - layer[0];
}

// Cells are numbered with z fastest, so cell k n_z is the lowest one of ring k. All
// cells of a ring have one volume.
void level_profile(const struct grid *grid, const double *sum, int snapshots,
                   const struct split_cell *cell, double height, double *turned,
                   bool *counts)
{
    const int n_z = grid->axis[2].n;
    int layer[2];
    const double upper = layers_beside(&grid->axis[2], height, layer);
    for (int k = 0; k < grid->axis[0].n; k++) {
        double turning = 0, inertia = 0, volume = 0;
        for (int side = 0; side < 2; side++) {
            const int at = k * n_z + layer[side];
            const double share = side ? upper : 1 - upper;
            const double *of = sum + (size_t)at * SUM_ALL;
            turning += share * of[SUM_TURNING + 1];
            inertia += share * of[SUM_INERTIA];
            volume += share * of[SUM_VOLUME];
        }
        const double r = cell_centre(grid, k * n_z, 0);
        const double fraction = volume / (cell_volume(grid, k * n_z) * snapshots);
        counts[k] = inertia > 0 && fraction >= cell->least_fraction &&
                    r >= cell->inner && r <= cell->outer;
        const double share = counts[k] ? turning / (inertia * cell->rate) : 0;
        turned[k] = cell->inner_turns ? 1 - share : share;
    }
}

// In place: `n` never overtakes k.
void fit_levels(const struct grid *grid, const double *sum, int snapshots,
                const struct split_cell *cell, double smoothing, struct band_fit *fit)
{
    const int n_r = grid->axis[0].n;
    double *turned = NEW_ARRAY(double, n_r), *r = NEW_ARRAY(double, n_r);
    bool *counts = NEW_ARRAY(bool, n_r);
    for (int level = 0; level < cell->n_level; level++) {
        level_profile(grid, sum, snapshots, cell, cell->height[level], turned, counts);
        int n = 0;
        for (int k = 0; k < n_r; k++) {
            if (!counts[k]) continue;
            r[n] = cell_centre(grid, k * grid->axis[2].n, 0);
            turned[n++] = turned[k];
        }
        fit[level] = fit_band(r, turned, n, smoothing);
    }
    free(turned);
    free(r);
    free(counts);
}

// A level at HEIGHT itself is `below`.
bool band_at(const struct split_cell *cell, const struct band_fit *fit, double height,
             double *centre, double *width)
{
    int below = -1, above = -1;
    for (int k = 0; k < cell->n_level; k++) {
        if (!fit[k].converged) continue;
        if (cell->height[k] <= height) below = k;
        if (cell->height[k] > height && above < 0) above = k;
    }
    if (below < 0 && above < 0) return false;
    const int a = below < 0 ? above : below, b = above < 0 ? below : above;
    const double rise = cell->height[b] - cell->height[a];
    const double share = rise > 0 ? (height - cell->height[a]) / rise : 0;
    *centre = (1 - share) * fit[a].centre + share * fit[b].centre;
    *width = (1 - share) * fit[a].width + share * fit[b].width;
    return true;
}
