// SPDX-License-Identifier: GPL-3.0-or-later
// What a caller can ask of a running assembly, in SI. Forces and histories are those of
// the last force evaluation, at the places before the last displacement.
//
// Stress of dem_census, compression positive, over the volume V of the box:
//     sigma_kl = 1/V sum over contacts of (R_i + R_j - S) n_k F_l,
// with F on the second grain and S what the radii share, also where an overlap at the
// start does not push; walls add arm n_k F_l, with F on the wall.
// dem_unbalanced_ratio [K 4.20]: mean |F_i| of free grains over mean |F_ij| of
// contacts.
#include "dem/engine.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

int64_t dem_cycle(const struct dem *dem)
{
    return dem->cycle;
}

double dem_time(const struct dem *dem)
{
    const double since = (double)(dem->cycle - dem->step_since) * dem->time_step;
    return (dem->time_before + since) * dem->unit.time;
}

double dem_time_step(const struct dem *dem)
{
    return dem->time_step * dem->unit.time;
}

bool dem_grains_turn(const struct dem *dem)
{
    return dem->features & FEATURE_ROTATION;
}

int dem_deepest_in_wall(const struct dem *dem, int wall, double *overlap)
{
    int deepest = -1;
    *overlap = -INFINITY;
    for (int i = 0; i < dem->n_particle; i++) {
        const double now =
            wall_geometry(dem, i, wall, 0).overlap / dem->place[i].radius;
        if (!(now > *overlap)) continue;
        *overlap = now;
        deepest = dem->id[i];
    }
    return deepest;
}

void dem_positions(const struct dem *dem, struct vector *position)
{
    for (int i = 0; i < dem->n_particle; i++)
        position[dem->id[i]] =
            scale(dem->unit.length,
                  add(dem->start[i], as_vector(dem->place[i].displacement)));
}

void dem_displacements(const struct dem *dem, struct vector *displacement)
{
    for (int i = 0; i < dem->n_particle; i++)
        displacement[dem->id[i]] =
            scale(dem->unit.length, as_vector(dem->place[i].displacement));
}

void dem_velocities(const struct dem *dem, struct vector *velocity)
{
    const double unit = dem->unit.length / dem->unit.time;
    for (int i = 0; i < dem->n_particle; i++)
        velocity[dem->id[i]] = scale(unit, as_vector(velocity_of(dem, i)));
}

void dem_velocities_at_places(const struct dem *dem, struct vector *velocity)
{
    const double unit = dem->unit.length / dem->unit.time;
    for (int i = 0; i < dem->n_particle; i++) {
        const struct motion load = load_on_grain(dem, i);
        const double kick = 0.5 * dem->time_step * dem->mobility[i][0];
        const struct vector now =
            add(as_vector(velocity_of(dem, i)), scale(kick, as_vector(load.linear)));
        velocity[dem->id[i]] = scale(unit, now);
    }
}

void dem_spins(const struct dem *dem, struct vector *spin)
{
    for (int i = 0; i < dem->n_particle; i++)
        spin[dem->id[i]] = scale(1 / dem->unit.time, as_vector(spin_of(dem, i)));
}

void dem_loads(const struct dem *dem, struct vector *force, struct vector *moment)
{
    const double unit = dem->unit.stiffness * dem->unit.length;
    for (int i = 0; i < dem->n_particle; i++) {
        const struct motion load = load_on_grain(dem, i);
        force[dem->id[i]] = scale(unit, as_vector(load.linear));
        moment[dem->id[i]] = scale(unit * dem->unit.length, as_vector(load.angular));
    }
}

// Levers are those of the last forces, a step before the places.
struct dem_group_state dem_group_state(const struct dem *dem, int group)
{
    const struct driven_group *of = &dem->group[group];
    const double angle = compensated_value(of->angle);
    const double then = angle - places_ahead(dem) * dem->time_step * of->spin;
    struct vector force = {0, 0, 0}, moment = {0, 0, 0};
    double work = 0;
    for (int i = 0; i < dem->n_particle; i++) {
        if (dem->group_of[i] != group + 1) continue;
        if (dem->grain_ledger) work += dem->grain_ledger[i][0] - booked_ahead(dem, i);
        const struct motion load = load_on_grain(dem, i);
        const struct vector push = as_vector(load.linear);
        force = add(force, push);
        moment = add(moment, add(cross(driven_lever(dem, i, then), push),
                                 as_vector(load.angular)));
    }
    const double length = dem->unit.length, unit = dem->unit.stiffness * length;
    return (struct dem_group_state){.force = scale(unit, force),
                                    .moment = scale(unit * length, moment),
                                    .displacement =
                                        scale(length, group_translation(of)),
                                    .angle = angle,
                                    .work = unit * length * work};
}

void dem_radii(const struct dem *dem, double *radius)
{
    for (int i = 0; i < dem->n_particle; i++)
        radius[dem->id[i]] = dem->unit.length * dem->place[i].radius;
}

void dem_bonds_intact(const struct dem *dem, uint8_t *intact)
{
    for (int b = 0; b < dem->n_bond; b++)
        intact[b] = dem->bond_strength[DEM_CRACK_NORMAL][b] >= 0;
}

const struct dem_crack *dem_cracks(const struct dem *dem, int *count)
{
    *count = dem->n_crack;
    return dem->crack;
}

static struct vector pair_force(const struct dem *dem, int pair)
{
    return lane_vector(dem->pairs.load[pair / PAIRS_IN_GROUP].force,
                       pair % PAIRS_IN_GROUP);
}

static bool touches(const struct dem *dem, int pair,
                    const struct pair_geometry *geometry)
{
    return geometry->overlap >= 0 || is_bonded(dem, pair);
}

static struct dem_contact pair_contact(const struct dem *dem, int pair,
                                       const struct pair_geometry *geometry)
{
    const int32_t a = dem->id[dem->pairs.particle[pair][0]];
    const int32_t b = dem->id[dem->pairs.particle[pair][1]];
    const double unit = dem->unit.stiffness * dem->unit.length;
    const struct dem_bridge bridge = bridge_of_pair(dem, pair);
    return (struct dem_contact){
        .particle = {a < b ? a : b, a < b ? b : a},
        .bond = is_bonded(dem, pair) ? dem->pairs.bond[pair] : -1,
        .overlap = geometry->overlap * dem->unit.length,
        .force = scale(a < b ? unit : -unit, pair_force(dem, pair)),
        .position = scale(dem->unit.length, geometry->position),
        .bridge_volume = bridge.volume,
        .bridge_force = bridge.force};
}

static struct dem_contact wall_contact(const struct dem *dem,
                                       const struct wall_pair *pair,
                                       const struct wall_geometry *geometry)
{
    const int i = pair->particle;
    const struct dem_bridge bridge = bridge_of_wall_pair(dem, pair);
    const struct vector centre =
        subtract(position_now(dem, i), scale(places_ahead(dem) * dem->time_step,
                                             as_vector(velocity_of(dem, i))));
    return (struct dem_contact){
        .particle = {dem->id[i], -1 - pair->wall},
        .bond = -1,
        .overlap = geometry->overlap * dem->unit.length,
        .force = scale(-dem->unit.stiffness * dem->unit.length, pair->load),
        .position = scale(dem->unit.length,
                          add(centre, scale(geometry->arm, geometry->normal))),
        .bridge_volume = bridge.volume,
        .bridge_force = bridge.force};
}

// Pairs first, then walls, each by its two numbers.
static int by_particles(const void *a, const void *b)
{
    const struct dem_contact *p = a, *q = b;
    const bool p_wall = p->particle[1] < 0, q_wall = q->particle[1] < 0;
    if (p_wall != q_wall) return p_wall - q_wall;
    if (p->particle[0] != q->particle[0])
        return p->particle[0] < q->particle[0] ? -1 : 1;
    const int32_t x = p_wall ? q->particle[1] : p->particle[1];
    const int32_t y = p_wall ? p->particle[1] : q->particle[1];
    return (x > y) - (x < y);
}

// Geometry is that of the last forces, a step before the places.
struct dem_contact *dem_contacts(const struct dem *dem, int *count)
{
    struct dem_contact *contact =
        NEW_ARRAY(struct dem_contact, dem->pairs.n_pair + dem->n_wall_pair);
    int n = 0;
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const struct pair_geometry geometry = pair_geometry(dem, p, places_ahead(dem));
        if (touches(dem, p, &geometry) || is_bridged(dem, p))
            contact[n++] = pair_contact(dem, p, &geometry);
    }
    for (int k = 0; k < dem->n_wall_pair; k++) {
        const struct wall_pair *pair = &dem->wall_pair[k];
        const struct wall_geometry geometry =
            wall_geometry(dem, pair->particle, pair->wall, places_ahead(dem));
        if (geometry.overlap >= 0 || is_wall_bridged(dem, pair))
            contact[n++] = wall_contact(dem, pair, &geometry);
    }
    qsort(contact, (size_t)n, sizeof *contact, by_particles);
    *count = n;
    return contact;
}

static void count_contact(struct dem_census *census, double overlap)
{
    census->contacts++;
    census->mean_overlap += overlap;
    census->largest_overlap = fmax(census->largest_overlap, overlap);
}

static void count_wall(struct dem_census *census, int wall, double overlap)
{
    if (!(overlap > census->wall_overlap)) return;
    census->wall_overlap = overlap;
    census->deepest_wall = wall;
}

// Bridges across a gap count in the stress, not as contacts.
struct dem_census dem_census(const struct dem *dem)
{
    struct dem_census census = {.deepest_wall = -1};
    double volume = 1;
    for (int axis = 0; axis < 3; axis++)
        volume *= dem->box_upper[axis] - dem->box_lower[axis];
    const double unit = dem->unit.stiffness / dem->unit.length / volume;
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const struct pair_geometry geometry = pair_geometry(dem, p, places_ahead(dem));
        if (!touches(dem, p, &geometry) && !is_bridged(dem, p)) continue;
        if (touches(dem, p, &geometry)) count_contact(&census, geometry.overlap);
        const int32_t *end = dem->pairs.particle[p];
        const double branch =
            dem->place[end[0]].radius + dem->place[end[1]].radius - geometry.shared;
        const struct vector force = pair_force(dem, p);
        for (int k = 0; k < 9; k++)
            census.stress[k / 3][k % 3] += unit * branch *
                                           component(geometry.normal, k / 3) *
                                           component(force, k % 3);
    }
    for (int p = 0; p < dem->n_wall_pair; p++) {
        const struct wall_pair *pair = &dem->wall_pair[p];
        const struct wall_geometry geometry =
            wall_geometry(dem, pair->particle, pair->wall, places_ahead(dem));
        count_wall(&census, pair->wall, geometry.overlap);
        for (int k = 0; k < 9; k++)
            census.stress[k / 3][k % 3] -= unit * geometry.arm *
                                           component(geometry.normal, k / 3) *
                                           component(pair->load, k % 3);
    }
    if (census.contacts > 0) census.mean_overlap /= census.contacts;
    return census;
}

static double mean(double sum, int count)
{
    return count > 0 ? sum / count : 0;
}

double dem_unbalanced_ratio(const struct dem *dem)
{
    double unbalanced = 0, force = 0;
    int n_free = 0, n_contact = 0;
    for (int i = 0; i < dem->n_particle; i++) {
        if (dem->mobility[i][0] <= 0) continue;
        unbalanced += norm(as_vector(load_on_grain(dem, i).linear));
        n_free++;
    }
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const double size = norm(pair_force(dem, p));
        force += size;
        n_contact += size > 0 || is_bonded(dem, p);
    }
    for (int k = 0; k < dem->n_wall_pair; k++) {
        const double size = norm(dem->wall_pair[k].load);
        force += size;
        n_contact += size > 0;
    }
    if (unbalanced <= 0) return 0;
    return mean(unbalanced, n_free) / mean(force, n_contact);
}
