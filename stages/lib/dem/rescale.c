// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes that shrink or stretch, and grains that grow.
//
// Centres move to lower + stretch (x - lower), radii grow by GROWTH. Afterwards grains
// start anew: `start` is where they are and displacements are 0, so pairs get new
// separations and overlaps but keep their histories. The list of pairs stays valid
// until the approach of two surfaces, counted in closed_in, has used up the skin.
#include "dem/engine.h"

#include <math.h>

static struct vector stretched(const struct dem *dem, struct vector x,
                               const double stretch[3])
{
    for (int axis = 0; axis < 3; axis++) {
        const double lower = dem->box_lower[axis];
        set_component(&x, axis, lower + stretch[axis] * (component(x, axis) - lower));
    }
    return x;
}

// Makes the present places the new starts.
static void move_starts(struct dem *dem, const double stretch[3], double growth)
{
    for (int i = 0; i < dem->n_particle; i++) {
        const struct vector moved =
            subtract(as_vector(dem->place[i].displacement), dem->place_at_search[i]);
        dem->start[i] = stretched(dem, position_now(dem, i), stretch);
        dem->place[i] = (struct place){{0, 0, 0}, growth * dem->place[i].radius};
        dem->place_at_search[i] = scale(-1, moved);
    }
}

static void stretch_box(struct dem *dem, const double stretch[3])
{
    for (int axis = 0; axis < 3; axis++) {
        const double edge = dem->box_upper[axis] - dem->box_lower[axis];
        dem->box_upper[axis] = dem->box_lower[axis] + stretch[axis] * edge;
        if (dem->period[axis] > 0)
            dem->period[axis] = dem->box_upper[axis] - dem->box_lower[axis];
    }
}

enum status dem_rescale(struct dem *dem, const double stretch[3], double growth)
{
    if (dem->n_bond > 0 || dem->liquid || dem->n_driven > 0) return STATUS_BAD_DATA;
    move_starts(dem, stretch, growth);
    stretch_box(dem, stretch);
    if (growth != 1) {
        set_masses(dem, NULL);
        set_external(dem);
    }
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        set_pair_place(dem, &dem->pairs.group[p / PAIRS_IN_GROUP], p % PAIRS_IN_GROUP);
        if (dem->pairs.laws && growth != 1) set_pair_law(dem, p);
        if (dem->pairs.rolling && growth != 1)
            set_pair_rolling(dem, p, law_of_pair(dem, p).normal_stiffness);
    }
    if (growth != 1) set_wall_laws(dem);

    // How much two grains that do not touch may have approached, half of it each.
    const double least = fmin(stretch[0], fmin(stretch[1], stretch[2]));
    const double reach = 2 * dem->largest_radius + dem->skin;
    const double nearer =
        fmax(0, 1 - least) * reach + fmax(0, 1 - 1 / growth) * 2 * dem->largest_radius;
    dem->closed_in += 0.5 * nearer;
    dem->travelled += 0.5 * nearer;
    return STATUS_OK;
}

void dem_box(const struct dem *dem, struct vector *lower, struct vector *upper)
{
    for (int axis = 0; axis < 3; axis++) {
        set_component(lower, axis, dem->box_lower[axis] * dem->unit.length);
        set_component(upper, axis, dem->box_upper[axis] * dem->unit.length);
    }
}
