// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes that shrink or stretch, and grains that grow.
//
// Centres move to lower + stretch (x - lower), radii grow by GROWTH. Afterwards grains
// start anew: `start` is where they are and displacements are 0, so pairs get new
// separations and overlaps but keep their histories. The list of pairs stays valid
// until the approach of two surfaces, counted in closed_in, has used up the skin.
//
// Work on the grains: the change of elastic energy, and what bridges pull with times
// the change of their gaps.
#include "dem/engine.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

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

// New separations and overlaps of all pairs. Overlaps at rest stay so: the new overlap
// is REACHED_BEFORE, overlap and distance together, less the new distance. Returns what
// bridges took up as their gaps changed.
static double place_pairs(struct dem *dem, const double *gap_before,
                          const double *reached_before, bool grown)
{
    double taken = 0;
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const int group = p / PAIRS_IN_GROUP, lane = p % PAIRS_IN_GROUP;
        struct pair_group *of = &dem->pairs.group[group];
        set_pair_place(dem, of, lane);
        if (reached_before) of->overlap[lane] = reached_before[p] - of->distance[lane];
        if (dem->pairs.laws && grown) set_pair_law(dem, p);
        if (dem->pairs.rolling && grown)
            set_pair_rolling(dem, p, law_of_pair(dem, p).normal_stiffness);
        if (gap_before && is_bridged(dem, p))
            taken += dem->pairs.liquid[group].pull[lane] *
                     (-pair_geometry(dem, p, 0).overlap - gap_before[p]);
    }
    return taken;
}

static double *gaps_now(const struct dem *dem)
{
    double *gap = NEW_ARRAY(double, dem->pairs.n_pair);
    for (int p = 0; p < dem->pairs.n_pair; p++)
        gap[p] = -pair_geometry(dem, p, 0).overlap;
    return gap;
}

// At which distance two grains begin to push: that of their radii, less where they
// overlapped at rest.
static double *reaches_now(const struct dem *dem)
{
    double *reach = NEW_ARRAY(double, dem->pairs.n_pair);
    for (int p = 0; p < dem->pairs.n_pair; p++)
        reach[p] = dem->pairs.group[p / PAIRS_IN_GROUP].overlap[p % PAIRS_IN_GROUP] +
                   dem->pairs.group[p / PAIRS_IN_GROUP].distance[p % PAIRS_IN_GROUP];
    return reach;
}

// How much two grains that do not touch may have approached, half of it each.
static double approach(const struct dem *dem, const double stretch[3], double growth)
{
    const double least = fmin(stretch[0], fmin(stretch[1], stretch[2]));
    const double reach = 2 * dem->largest_radius + dem->skin + bridge_cutoff(dem);
    const double nearer =
        fmax(0, 1 - least) * reach + fmax(0, 1 - 1 / growth) * 2 * dem->largest_radius;
    return 0.5 * nearer;
}

enum status dem_rescale(struct dem *dem, const double stretch[3], double growth)
{
    const bool grown = growth != 1, wet = dem->liquid;
    if (dem->n_bond > 0 || dem->n_driven > 0 || (wet && grown)) return STATUS_BAD_DATA;
    const double elastic = dem->balance_energy ? elastic_energy(dem) : 0;
    double *gap = dem->balance_energy && wet ? gaps_now(dem) : NULL;
    double *reach = dem->unstressed ? reaches_now(dem) : NULL;
    move_starts(dem, stretch, growth);
    stretch_box(dem, stretch);
    if (grown) {
        set_masses(dem, NULL);
        set_external(dem);
    }
    const double taken = place_pairs(dem, gap, reach, grown);
    if (grown) set_wall_laws(dem);
    count_approach(dem, approach(dem, stretch, growth));
    free(gap);
    free(reach);
    if (!dem->balance_energy) return STATUS_OK;
    dem->energy_ledger.bridges += taken;
    dem->energy_ledger.gained += taken + elastic_energy(dem) - elastic;
    return STATUS_OK;
}

void dem_box(const struct dem *dem, struct vector *lower, struct vector *upper)
{
    for (int axis = 0; axis < 3; axis++) {
        set_component(lower, axis, dem->box_lower[axis] * dem->unit.length);
        set_component(upper, axis, dem->box_upper[axis] * dem->unit.length);
    }
}
