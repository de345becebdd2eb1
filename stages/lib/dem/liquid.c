// SPDX-License-Identifier: GPL-3.0-or-later
// Liquid bridges between grains [G 2]: they form where two grains touch and last until
// they rupture [G 4]. With r = 2 / (1/a + 1/b) the effective radius of radii a and b,
//     volume = V / r^3,  gap = (d - a - b) / r,  pull = gamma r f(volume, gap),
// where f is the chosen model or table (bridges/). Before the pair sweep comes to a
// group, update_bridges finds `pull` of its pairs, many at once; the sweep subtracts it
// from the normal force. `gap` has the digits of the overlap (pair_kinematics.h): it is
// found from displacements, not from a difference of distances.
//
// Walls: a plane is a sphere of infinite radius, r = 2 a and asymmetry 1. Where a wall
// has the principal curvatures p and q (> 0 towards the grain, < 0 around it),
//     2 / r = sqrt((1/a + p)(1/a + q)),
// what Derjaguin's approximation makes of two curved surfaces: with little liquid the
// force at contact, 2 pi gamma r cos(theta), is exact. The table takes the shape of the
// bridge for that on a plane. Against Young and Laplace's equation for a sphere around
// the grain or beside it, of ten of its radii, forces up to 0.85 of rupture are then
// off by 0.2 % where volume = 1e-4, 0.8 % at 1e-3, 2 % at 0.01 and 4 % at 0.1, and
// rupture by 0.8, 1.6, 2.8 and 4 %; half of that at twenty radii. Rings and blocks
// count as flat, their edges too.
//
// Dry grains that adhere [adhesion.c] are bridges of another kind: f then is that of
// Johnson, Kendall and Roberts, and `volume` the unit of gaps of the contact.
//
// The grains among which liquid is shared are counted as of the end of the cycle
// before. So the order in which bridges come and go, and with it the number of threads,
// does not matter.
#include "dem/engine.h"

#include "basics/memory.h"
#include "bridges/ratios.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Pairs at once: few enough for their data to stay in the cache.
enum { BATCH = 32 * PAIRS_IN_GROUP };

// Bridges that pull in this batch; lengths in effective radii [G 1].
struct pulling {
    int count;
    int pair[BATCH];
    double asymmetry[BATCH], volume[BATCH], gap[BATCH], force[BATCH];
};

double bridge_cutoff(const struct dem *dem)
{
    return dem->liquid ? dem->liquid->cutoff : 0;
}

// Rupture gap in effective radii [G 2]; with the table, where the exact bridge
// ruptures.
static double rupture_gap(const struct liquid *liquid, double asymmetry, double volume)
{
    if (liquid->is_adhesion) return adhesion_rupture(volume);
    if (liquid->table) return bridge_ratios_rupture(liquid->table, asymmetry, volume);
    const struct bridge bridge = {
        {1, 1}, {liquid->is.contact_angle, liquid->is.contact_angle}, 1, volume};
    return bridge_rupture_distance(&bridge);
}

double wall_bridge_cutoff(const struct dem *dem)
{
    return walls_are_wet(dem) ? dem->liquid->wall_cutoff : 0;
}

// Volume that grain I gives to each of its bridges; all of it if it has none yet.
static double share_of(const struct liquid *liquid, int i)
{
    const int bridges = liquid->bridges[i];
    return liquid->is.volume / (bridges > 0 ? bridges : 1);
}

static double volume_between(const struct liquid *liquid, int i, int j)
{
    return liquid->is.shared ? share_of(liquid, i) + share_of(liquid, j)
                             : liquid->is.volume;
}

// E* of a Hertz contact from the STIFFNESS of its law, 4/3 E* sqrt(RADIUS).
static double modulus_of(double stiffness, double radius)
{
    return 0.75 * stiffness / sqrt(radius);
}

// `volume` of a bridge between two grains with this effective RADIUS.
static double pair_volume(const struct dem *dem, int i, int j, double radius)
{
    const struct liquid *liquid = dem->liquid;
    if (!liquid->is_adhesion)
        return volume_between(liquid, i, j) / (radius * radius * radius);
    const double stiffness = pair_law(dem, i, j).normal_stiffness;
    return adhesion_unit(liquid->is.surface_tension,
                         modulus_of(stiffness, 0.5 * radius), radius);
}

// The same at a wall. The law of a contact with a wall has the radius of the grain.
static double wall_volume(const struct dem *dem, const struct wall_pair *pair)
{
    const struct liquid *liquid = dem->liquid;
    const double radius = pair->bridge_radius;
    if (!liquid->is_adhesion)
        return (liquid->is.shared ? share_of(liquid, pair->particle)
                                  : liquid->is.volume) /
               (radius * radius * radius);
    const double grain = dem->place[pair->particle].radius;
    return adhesion_unit(liquid->is.surface_tension,
                         modulus_of(pair->law.normal_stiffness, grain), radius);
}

// Sets what follows from a bridge's VOLUME over the cube of the effective radius,
// unless it has that already.
static void take_volume(const struct liquid *liquid, double asymmetry, double volume,
                        double *now, double *rupture)
{
    if (!(volume < *now) && !(volume > *now)) return;
    *now = volume;
    *rupture = rupture_gap(liquid, asymmetry, volume);
}

static void set_volume(const struct dem *dem, struct liquid_group *group, int lane,
                       int i, int j)
{
    take_volume(dem->liquid, group->asymmetry[lane],
                pair_volume(dem, i, j, group->radius[lane]), &group->volume[lane],
                &group->rupture[lane]);
}

static void count_at_end(struct liquid *liquid, int i, int by)
{
#pragma omp atomic
    liquid->next[i] += by;
#pragma omp atomic write
    liquid->changed = 1;
}

static void count_bridge(struct liquid *liquid, int i, int j, int by)
{
    count_at_end(liquid, i, by);
    count_at_end(liquid, j, by);
}

// Forms, keeps or ruptures the bridge in lane LANE of group K, at GAP; adds it to
// PULLING if it pulls.
static void update_bridge(const struct dem *dem, int k, int lane, double gap,
                          struct pulling *pulling)
{
    struct liquid_group *liquid = &dem->pairs.liquid[k];
    const struct dem_liquid *is = &dem->liquid->is;
    const int i = first_grain(&dem->pairs.group[k], lane);
    const int j = second_grain(&dem->pairs.group[k], lane);
    const bool existed = liquid->volume[lane] > 0;
    const bool exists = gap <= 0 || (existed && gap <= liquid->rupture[lane]);
    if (exists != existed) count_bridge(dem->liquid, i, j, exists - existed);
    if (!exists)
        liquid->volume[lane] = 0;
    else if (!existed || is->shared)
        set_volume(dem, liquid, lane, i, j);
    if (!exists || (gap <= 0 && !is->pulls_in_contact)) return;
    pulling->pair[pulling->count] = k * PAIRS_IN_GROUP + lane;
    pulling->asymmetry[pulling->count] = liquid->asymmetry[lane];
    pulling->volume[pulling->count] = liquid->volume[lane];
    pulling->gap[pulling->count++] = gap;
}

static void find_forces(const struct liquid *liquid, int count, const double *asymmetry,
                        const double *volume, const double *gap, double *force)
{
    if (liquid->is_adhesion)
        adhesion_pulls(count, volume, gap, force);
    else if (liquid->table)
        bridge_ratios_forces(liquid->table, count, asymmetry, volume, gap, force);
    else
        bridge_model_forces(liquid->is.model, liquid->is.contact_angle, count, volume,
                            gap, force);
}

static void update_bridge_batch(const struct dem *dem, int begin, int end)
{
    struct pulling pulling;
    pulling.count = 0;
    for (int k = begin; k < end; k++) {
        _Alignas(CACHE_LINE) double gap[PAIRS_IN_GROUP];
        unsigned wet = dem->gaps(dem, k, gap);
        memset(dem->pairs.liquid[k].pull, 0, sizeof dem->pairs.liquid[k].pull);
        for (; wet; wet &= wet - 1) {
            const int lane = __builtin_ctz(wet);
            update_bridge(dem, k, lane, gap[lane], &pulling);
        }
    }
    find_forces(dem->liquid, pulling.count, pulling.asymmetry, pulling.volume,
                pulling.gap, pulling.force);
    for (int k = 0; k < pulling.count; k++) {
        const int p = pulling.pair[k], lane = p % PAIRS_IN_GROUP;
        struct liquid_group *group = &dem->pairs.liquid[p / PAIRS_IN_GROUP];
        const double tension = dem->liquid->is.surface_tension;
        // find_forces set it. NOLINTNEXTLINE(clang-analyzer-core.*)
        group->pull[lane] = tension * group->radius[lane] * pulling.force[k];
    }
}

void update_bridges(const struct dem *dem, int begin, int end)
{
    const int step = BATCH / PAIRS_IN_GROUP;
    for (int k = begin; k < end; k += step)
        update_bridge_batch(dem, k, k + step < end ? k + step : end);
}

void publish_bridge_counts(struct dem *dem)
{
    struct liquid *liquid = dem->liquid;
    if (!liquid->changed) return;
    liquid->changed = 0;
    memcpy(liquid->bridges, liquid->next,
           (size_t)dem->n_particle * sizeof *liquid->bridges);
}

void count_bridges(struct dem *dem)
{
    struct liquid *liquid = dem->liquid;
    memset(liquid->next, 0, (size_t)dem->n_particle * sizeof *liquid->next);
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const int32_t *end = dem->pairs.particle[p];
        if (dem->pairs.liquid[p / PAIRS_IN_GROUP].volume[p % PAIRS_IN_GROUP] > 0)
            count_bridge(liquid, end[0], end[1], 1);
    }
    for (int k = 0; k < dem->n_wall_pair; k++)
        liquid->next[dem->wall_pair[k].particle] +=
            is_wall_bridged(dem, &dem->wall_pair[k]);
    liquid->changed = 1;
    publish_bridge_counts(dem);
}

void set_bridge_radius(const struct dem *dem, int pair)
{
    const struct pair_group *group = &dem->pairs.group[pair / PAIRS_IN_GROUP];
    const int lane = pair % PAIRS_IN_GROUP;
    const double a = dem->place[first_grain(group, lane)].radius;
    const double b = dem->place[second_grain(group, lane)].radius;
    struct liquid_group *liquid = &dem->pairs.liquid[pair / PAIRS_IN_GROUP];
    liquid->radius[lane] = 2 / (1 / a + 1 / b);
    if (dem->liquid->table) liquid->asymmetry[lane] = bridge_asymmetry(a, b);
}

// Effective radius of a grain of radius A at a wall.
static double radius_at_wall(double a, const struct dem_wall *wall)
{
    const bool is_sphere = wall->shape == DEM_SPHERE;
    if (!is_sphere && wall->shape != DEM_CYLINDER) return 2 * a;
    const double curved = 1 / a + (wall->outside ? 1 : -1) / wall->radius;
    return 2 / (is_sphere ? curved : sqrt(curved / a));
}

void set_wall_bridge_radius(const struct dem *dem, struct wall_pair *pair)
{
    pair->bridge_radius =
        radius_at_wall(dem->place[pair->particle].radius, &dem->wall[pair->wall].is);
}

void update_wall_bridge(const struct dem *dem, struct wall_pair *pair, double overlap)
{
    struct liquid *liquid = dem->liquid;
    const double radius = pair->bridge_radius, gap = -overlap / radius;
    const bool existed = pair->bridge_volume > 0;
    const bool exists = gap <= 0 || (existed && gap <= pair->bridge_rupture);
    if (exists != existed) count_at_end(liquid, pair->particle, exists - existed);
    if (!exists) pair->bridge_volume = 0;
    pair->bridge_pull = 0;
    if (exists && (!existed || liquid->is.shared))
        take_volume(liquid, 1, wall_volume(dem, pair), &pair->bridge_volume,
                    &pair->bridge_rupture);
    if (!exists || (gap <= 0 && !liquid->is.pulls_in_contact)) return;
    double force;
    find_forces(liquid, 1, &(double){1}, &pair->bridge_volume, &gap, &force);
    pair->bridge_pull = liquid->is.surface_tension * radius * force;
}

void form_bridges(struct dem *dem)
{
    for (int turn = 0; turn < 2; turn++) { // the second pass with known shares
        update_bridges(dem, 0, dem->pairs.n_group);
        for (int k = 0; walls_are_wet(dem) && k < dem->n_wall_pair; k++)
            update_wall_bridge(dem, &dem->wall_pair[k], dem->wall_pair[k].depth);
        publish_bridge_counts(dem);
    }
}

// Range of radii and of bridge volumes for the table. Shared volume is least where a
// largest grain touches as many smallest ones as fit around it: about four a square of
// their radius.
static struct bridge_sizes sizes_of(const struct dem *dem, const struct liquid *liquid)
{
    const double small = dem->smallest_radius, large = dem->largest_radius;
    const double around = 4 * (1 + large / small) * (1 + large / small);
    const int n_wall = liquid->is.wets_walls ? dem->n_wall : 0;
    const double volume = liquid->is.volume;
    struct bridge_sizes sizes = {
        {small, large},
        {liquid->is.shared ? (n_wall > 0 ? 1 : 2) * volume / around : volume,
         liquid->is.shared ? 2 * volume : volume},
        {0, 0}};
    for (int w = 0; w < n_wall; w++) {
        const struct dem_wall *wall = &dem->wall[w].is;
        const double least = radius_at_wall(small, wall);
        sizes.plane[0] = w > 0 ? fmin(sizes.plane[0], least) : least;
        sizes.plane[1] = fmax(sizes.plane[1], radius_at_wall(large, wall));
    }
    return sizes;
}

// The longest gap that a bridge of any two grains can have. For an effective radius
// equal grains hold a bridge longest, so radii from the smallest to the largest are
// sampled.
static double longest_gap(const struct dem *dem, const struct liquid *liquid)
{
    enum { LOOKED_AT = 64 };
    const double between = 1.001; // covers what lies between samples
    const double ratio = dem->largest_radius / dem->smallest_radius;
    const double volume = (liquid->is.shared ? 2 : 1) * liquid->is.volume;
    double cutoff = 0;
    for (int k = 0; k <= LOOKED_AT; k++) {
        const double radius = dem->smallest_radius * pow(ratio, k / (double)LOOKED_AT);
        const double gap = rupture_gap(liquid, 0, volume / (radius * radius * radius));
        cutoff = fmax(cutoff, radius * gap);
    }
    return ratio > 1 ? between * cutoff : cutoff;
}

// The same to a wall, of whatever shape.
static double longest_gap_to_walls(const struct dem *dem, const struct liquid *liquid)
{
    enum { LOOKED_AT = 64 };
    const double between = 1.001;
    const double ratio = dem->largest_radius / dem->smallest_radius;
    double cutoff = 0;
    for (int w = 0; w < dem->n_wall; w++)
        for (int k = 0; k <= LOOKED_AT; k++) {
            const double radius =
                radius_at_wall(dem->smallest_radius * pow(ratio, k / (double)LOOKED_AT),
                               &dem->wall[w].is);
            const double gap =
                rupture_gap(liquid, 1, liquid->is.volume / (radius * radius * radius));
            cutoff = fmax(cutoff, radius * gap);
        }
    return between * cutoff;
}

static enum status check_wet_walls(const struct dem *dem, struct reason *reason)
{
    for (int w = 0; w < dem->n_wall; w++) {
        const struct dem_wall *wall = &dem->wall[w].is;
        const bool round = wall->shape == DEM_CYLINDER || wall->shape == DEM_SPHERE;
        if (!round || wall->outside || wall->radius > dem->largest_radius) continue;
        return refuse(reason, STATUS_BAD_DATA,
                      "%s: wet walls must be wider than the largest grain, of "
                      "%g m: its radius is %g m",
                      wall_label(wall, w).text, dem->largest_radius * dem->unit.length,
                      wall->radius * dem->unit.length);
    }
    return STATUS_OK;
}

// Empty, with room for the counts of all grains.
static struct liquid *new_liquid(const struct dem *dem, const struct dem_liquid *is)
{
    struct liquid *liquid = NEW_ARRAY(struct liquid, 1);
    liquid->is = *is;
    liquid->bridges = NEW_ARRAY(int32_t, dem->n_particle);
    liquid->next = NEW_ARRAY(int32_t, dem->n_particle);
    return liquid;
}

enum status take_liquid(struct dem *dem, const struct dem_liquid *is,
                        struct reason *reason)
{
    const double length = dem->unit.length;
    struct liquid *liquid = dem->liquid = new_liquid(dem, is);
    liquid->is.surface_tension /= dem->unit.stiffness;
    liquid->is.volume /= length * length * length;
    if (is->wets_walls) {
        const enum status status = check_wet_walls(dem, reason);
        if (status) return status;
    }
    if (is->model == BRIDGE_TABLE) {
        const struct bridge_sizes sizes = sizes_of(dem, liquid);
        const enum status status =
            bridge_ratios_create(&sizes, is->contact_angle, &liquid->table, reason);
        if (status) return status;
    }
    liquid->cutoff = longest_gap(dem, liquid);
    if (is->wets_walls) liquid->wall_cutoff = longest_gap_to_walls(dem, liquid);
    return STATUS_OK;
}

// The gap at which a contact of effective RADIUS breaks grows with RADIUS and as
// materials get softer, and so does the size that it has under no load.
void take_adhesion(struct dem *dem, double work)
{
    const struct dem_liquid is = {
        .surface_tension = work, .pulls_in_contact = true, .wets_walls = true};
    struct liquid *liquid = dem->liquid = new_liquid(dem, &is);
    liquid->is_adhesion = true;
    double softest = 0; // compliance
    for (int k = 0; k < dem->n_material; k++)
        softest = fmax(softest, plane_strain_compliance(&dem->material[k]));
    double widest = dem->largest_radius;
    for (int w = 0; w < dem->n_wall; w++)
        widest = fmax(widest, radius_at_wall(dem->largest_radius, &dem->wall[w].is));
    const double unit = adhesion_unit(work, 1 / (2 * softest), widest);
    liquid->cutoff = liquid->wall_cutoff = widest * adhesion_rupture(unit);
    dem->expected_overlap =
        fmax(dem->expected_overlap, widest * adhesion_overlap(unit));
}

void free_liquid(struct liquid *liquid)
{
    if (!liquid) return;
    bridge_ratios_free(liquid->table);
    free(liquid->bridges);
    free(liquid->next);
    free(liquid);
}

// Its volume, m3, with RADIUS in m; adhesion has none.
static double liquid_of(const struct dem *dem, double volume, double radius)
{
    return dem->liquid->is_adhesion ? 0 : volume * radius * radius * radius;
}

struct dem_bridge bridge_of_pair(const struct dem *dem, int pair)
{
    if (!is_bridged(dem, pair)) return (struct dem_bridge){.volume = 0};
    const int lane = pair % PAIRS_IN_GROUP;
    const struct liquid_group *group = &dem->pairs.liquid[pair / PAIRS_IN_GROUP];
    const double length = dem->unit.length, radius = group->radius[lane] * length;
    const int32_t a = dem->id[dem->pairs.particle[pair][0]];
    const int32_t b = dem->id[dem->pairs.particle[pair][1]];
    return (struct dem_bridge){
        .particle = {a < b ? a : b, a < b ? b : a},
        .volume = liquid_of(dem, group->volume[lane], radius),
        .separation = -length * pair_geometry(dem, pair, places_ahead(dem)).overlap,
        .force = group->pull[lane] * dem->unit.stiffness * length};
}

struct dem_bridge bridge_of_wall_pair(const struct dem *dem,
                                      const struct wall_pair *pair)
{
    if (!is_wall_bridged(dem, pair)) return (struct dem_bridge){.volume = 0};
    const double length = dem->unit.length, radius = pair->bridge_radius * length;
    return (struct dem_bridge){.particle = {dem->id[pair->particle], -1 - pair->wall},
                               .volume = liquid_of(dem, pair->bridge_volume, radius),
                               .separation = -length * pair->depth,
                               .force =
                                   pair->bridge_pull * dem->unit.stiffness * length};
}

struct dem_bridge *dem_bridges(const struct dem *dem, int *count)
{
    *count = 0;
    if (!dem->liquid) return NULL;
    struct dem_bridge *bridge =
        NEW_ARRAY(struct dem_bridge, dem->pairs.n_pair + dem->n_wall_pair);
    for (int p = 0; p < dem->pairs.n_pair; p++)
        if (is_bridged(dem, p)) bridge[(*count)++] = bridge_of_pair(dem, p);
    for (int k = 0; k < dem->n_wall_pair; k++)
        if (is_wall_bridged(dem, &dem->wall_pair[k]))
            bridge[(*count)++] = bridge_of_wall_pair(dem, &dem->wall_pair[k]);
    qsort(bridge, (size_t)*count, sizeof *bridge, compare_pairs);
    return bridge;
}
