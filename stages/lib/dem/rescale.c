// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes that shrink or stretch, and grains that grow.
//
// Centres move to lower + stretch (x - lower), radii grow by GROWTH. Afterwards grains
// start anew: `start` is where they are and displacements are 0, so pairs get new
// separations and overlaps but keep their histories. The list of pairs stays valid
// until the approach of two surfaces, counted in closed_in, has used up the skin.
//
// The springs of friction feel a strain (dem_strain) as any other motion. With n and s
// the normal and the separation of the last forces before, n' and s' after, R the
// smallest rotation from n to n' and u = s' - s,
//     F^s' = f R F^s - k^s (u - (u.n') n'),   M^r' = f R M^r,
// where f is what a Hertz contact that opens keeps (pair_contact.h). Friction cuts them
// in the next cycle. The strain has no rotation, so nothing rolls.
//
// Work on the grains: the change of elastic energy, what these springs forgot, and what
// bridges pull with times the change of their gaps.
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

// ---- springs of friction ------------------------------------------------------------

// A pair at its last forces.
struct strained_pair {
    struct vector separation, normal;
    double overlap; // not below 0
};

static struct strained_pair pair_at_forces(const struct dem *dem, int pair)
{
    const struct pair_geometry at = pair_geometry(dem, pair, places_ahead(dem));
    const struct pair_group *group = &dem->pairs.group[pair / PAIRS_IN_GROUP];
    const double length = group->distance[pair % PAIRS_IN_GROUP] + at.stretch;
    return (struct strained_pair){scale(length, at.normal), at.normal,
                                  fmax(at.overlap, 0)};
}

// The same before the box was stretched: centres then were at the places of now over
// STRETCH, and as far behind these as they are now.
static struct strained_pair pair_before(const struct dem *dem, int pair,
                                        const struct strained_pair *now,
                                        const double stretch[3])
{
    const struct pair_group *group = &dem->pairs.group[pair / PAIRS_IN_GROUP];
    const struct vector places = lane_vector(group->separation, pair % PAIRS_IN_GROUP);
    struct vector separation = now->separation;
    for (int axis = 0; axis < 3; axis++)
        set_component(&separation, axis,
                      component(separation, axis) +
                          (1 / stretch[axis] - 1) * component(places, axis));
    const double length = norm(separation), longer = norm(now->separation) - length;
    return (struct strained_pair){separation, scale(1 / length, separation),
                                  fmax(now->overlap + longer, 0)};
}

// F, turned by the smallest rotation from the unit vector FROM to TO.
static struct vector turned(struct vector f, struct vector from, struct vector to)
{
    const struct vector both = add(from, to);
    const double mirrored = dot(both, f) / (1 + dot(from, to));
    return add(subtract(f, scale(mirrored, both)), scale(2 * dot(from, f), to));
}

static double spring_energy(struct vector force, double stiffness)
{
    return stiffness > 0 ? 0.5 * dot(force, force) / stiffness : 0;
}

// A spring with STIFFNESS (Hertz: at an overlap of 1) and its HISTORY in LANE, which
// the strain stretches by SLIDE. Returns the energy that it forgot.
static double strain_spring(const struct dem *dem, const struct strained_pair *before,
                            const struct strained_pair *now, double stiffness,
                            struct vector slide, double (*history)[PAIRS_IN_GROUP],
                            int lane)
{
    const bool hertz = dem->features & FEATURE_HERTZ;
    const double was = hertz ? stiffness * sqrt(before->overlap) : stiffness;
    const double is = hertz ? stiffness * sqrt(now->overlap) : stiffness;
    const bool opens = hertz && now->overlap < before->overlap;
    const double keeps = opens ? sqrt(now->overlap / before->overlap) : 1;
    const struct vector had = lane_vector(history, lane);
    const struct vector kept = scale(keeps, turned(had, before->normal, now->normal));
    const struct vector force = subtract(kept, scale(is, slide));
    for (int axis = 0; axis < 3; axis++)
        history[axis][lane] = component(force, axis);
    return spring_energy(had, was) - spring_energy(kept, is);
}

// The springs of all pairs that touch, after the STRETCH. Returns the energy that they
// forgot.
static double strain_springs(struct dem *dem, const double stretch[3])
{
    double forgotten = 0;
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const int group = p / PAIRS_IN_GROUP, lane = p % PAIRS_IN_GROUP;
        // No pair touched that is further apart than both can move in a step.
        if (dem->pairs.group[group].overlap[lane] < -2 * MAX_STEP) continue;
        const struct strained_pair now = pair_at_forces(dem, p);
        if (!(now.overlap > 0)) continue;
        const struct strained_pair before = pair_before(dem, p, &now, stretch);
        const struct contact_law law = law_of_pair(dem, p);
        const struct vector u = subtract(now.separation, before.separation);
        const struct vector slide = subtract(u, scale(dot(u, now.normal), now.normal));
        forgotten += strain_spring(dem, &before, &now, law.shear_stiffness, slide,
                                   dem->pairs.shear[group].force, lane);
        if (!dem->pairs.rolling) continue;
        const struct rolling_law rolling = pair_rolling(dem, p);
        forgotten += strain_spring(
            dem, &before, &now, rolling_stiffness(&rolling, law.normal_stiffness),
            (struct vector){0, 0, 0}, dem->pairs.rolling[group].moment, lane);
    }
    return forgotten;
}

// ---- the whole ----------------------------------------------------------------------

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

static enum status rescale(struct dem *dem, const double stretch[3], double growth,
                           bool strains)
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
    const double forgotten =
        strains && dem->pairs.shear ? strain_springs(dem, stretch) : 0;
    if (grown) set_wall_laws(dem);
    count_approach(dem, approach(dem, stretch, growth));
    free(gap);
    free(reach);
    if (!dem->balance_energy) return STATUS_OK;
    dem->energy_ledger.bridges += taken;
    dem->energy_ledger.slip += forgotten;
    dem->energy_ledger.gained += taken + forgotten + elastic_energy(dem) - elastic;
    return STATUS_OK;
}

enum status dem_rescale(struct dem *dem, const double stretch[3], double growth)
{
    return rescale(dem, stretch, growth, false);
}

enum status dem_strain(struct dem *dem, const double stretch[3], struct reason *reason)
{
    const enum status status = check_periods(dem, stretch, reason);
    if (status != STATUS_OK) return status;
    if (rescale(dem, stretch, 1, true) == STATUS_OK) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA, "bonds and driven groups are not strained");
}

void dem_box(const struct dem *dem, struct vector *lower, struct vector *upper)
{
    for (int axis = 0; axis < 3; axis++) {
        set_component(lower, axis, dem->box_lower[axis] * dem->unit.length);
        set_component(upper, axis, dem->box_upper[axis] * dem->unit.length);
    }
}
