// SPDX-License-Identifier: GPL-3.0-or-later
// Liquid bridges between grains [G 2]: made where two touch, kept until they rupture.
// Before the pair sweep comes to a group, how its bridges pull is found here, many at
// once; the sweep takes that off the normal force.
//
// Who shares liquid with how many is taken as of the end of the cycle before, so that
// the order in which bridges come and go, and with it the number of threads, does not
// matter.
#include "dem/engine.h"

#include "basics/memory.h"
#include "bridges/ratios.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Groups at once: few enough for what they touch to stay cached.
enum { BATCH = 32 * PAIRS_IN_GROUP };

// Bridges that pull; lengths in effective radii [G 1].
struct pulling {
    int count;
    int pair[BATCH];
    double asymmetry[BATCH], volume[BATCH], gap[BATCH], force[BATCH];
};

double bridge_reach(const struct dem *dem)
{
    return dem->liquid ? dem->liquid->reach : 0;
}

// In effective radii [G 2]; of the table, where the exact bridge ruptures.
static double rupture_gap(const struct liquid *liquid, double asymmetry, double volume)
{
    if (liquid->table) return bridge_ratios_rupture(liquid->table, asymmetry, volume);
    const struct bridge bridge = {
        {1, 1}, {liquid->is.contact_angle, liquid->is.contact_angle}, 1, volume};
    return bridge_rupture_distance(&bridge);
}

// What grain I gives to each of its bridges; all of it to the first.
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

static void set_volume(const struct dem *dem, struct liquid_group *group, int lane,
                       int i, int j)
{
    const double radius = group->radius[lane];
    const double volume =
        volume_between(dem->liquid, i, j) / (radius * radius * radius);
    if (!(volume < group->volume[lane]) && !(volume > group->volume[lane])) return;
    group->volume[lane] = volume;
    group->rupture[lane] = rupture_gap(dem->liquid, group->asymmetry[lane], volume);
}

static void count_bridge(struct liquid *liquid, int i, int j, int by)
{
    const int end[2] = {i, j};
    for (int k = 0; k < 2; k++) {
#pragma omp atomic
        liquid->next[end[k]] += by;
    }
#pragma omp atomic write
    liquid->changed = 1;
}

// How far the surfaces are apart in effective radii, with the digits of the overlap
// (pair_meet.h). Without branches: the compiler makes vectors of it.
static void gaps_of(const struct dem *dem, const struct pair_group *group,
                    const struct liquid_group *liquid, double gap[PAIRS_IN_GROUP])
{
    double square[PAIRS_IN_GROUP] = {0}, grown[PAIRS_IN_GROUP] = {0};
    for (int axis = 0; axis < 3; axis++)
        for (int lane = 0; lane < PAIRS_IN_GROUP; lane++) {
            const double start = group->separation[axis][lane];
            const double apart =
                dem->place[second_grain(group, lane)].displacement[axis] -
                dem->place[first_grain(group, lane)].displacement[axis];
            const double now = start + apart;
            square[lane] += now * now;
            grown[lane] += apart * (start + now);
        }
    for (int lane = 0; lane < PAIRS_IN_GROUP; lane++) {
        const double sum = sqrt(square[lane]) + group->distance[lane];
        gap[lane] =
            (grown[lane] - group->overlap[lane] * sum) / (sum * liquid->radius[lane]);
    }
}

// Makes, keeps or ruptures the bridge in lane LANE of group K, at GAP; lists it if it
// pulls.
static void keep_bridge(const struct dem *dem, int k, int lane, double gap,
                        struct pulling *pulling)
{
    struct liquid_group *liquid = &dem->pairs.liquid[k];
    const struct dem_liquid *is = &dem->liquid->is;
    const int i = first_grain(&dem->pairs.group[k], lane);
    const int j = second_grain(&dem->pairs.group[k], lane);
    const bool were = liquid->volume[lane] > 0;
    const bool are = gap <= 0 || (were && gap <= liquid->rupture[lane]);
    if (are != were) count_bridge(dem->liquid, i, j, are - were);
    if (!are)
        liquid->volume[lane] = 0;
    else if (!were || is->shared)
        set_volume(dem, liquid, lane, i, j);
    if (!are || (gap <= 0 && !is->pulls_in_contact)) return;
    pulling->pair[pulling->count] = k * PAIRS_IN_GROUP + lane;
    pulling->asymmetry[pulling->count] = liquid->asymmetry[lane];
    pulling->volume[pulling->count] = liquid->volume[lane];
    pulling->gap[pulling->count++] = gap;
}

static void find_forces(const struct liquid *liquid, struct pulling *pulling)
{
    if (liquid->table)
        bridge_ratios_forces(liquid->table, pulling->count, pulling->asymmetry,
                             pulling->volume, pulling->gap, pulling->force);
    else
        bridge_model_forces(liquid->is.model, liquid->is.contact_angle, pulling->count,
                            pulling->volume, pulling->gap, pulling->force);
}

static void wet_batch(const struct dem *dem, int begin, int end)
{
    struct pulling pulling;
    pulling.count = 0;
    for (int k = begin; k < end; k++) {
        double gap[PAIRS_IN_GROUP];
        gaps_of(dem, &dem->pairs.group[k], &dem->pairs.liquid[k], gap);
        memset(dem->pairs.liquid[k].pull, 0, sizeof dem->pairs.liquid[k].pull);
        for (int lane = 0; lane < PAIRS_IN_GROUP; lane++)
            keep_bridge(dem, k, lane, gap[lane], &pulling);
    }
    find_forces(dem->liquid, &pulling);
    for (int k = 0; k < pulling.count; k++) {
        const int p = pulling.pair[k], lane = p % PAIRS_IN_GROUP;
        struct liquid_group *group = &dem->pairs.liquid[p / PAIRS_IN_GROUP];
        group->pull[lane] =
            dem->liquid->is.surface_tension * group->radius[lane] * pulling.force[k];
    }
}

void wet_groups(const struct dem *dem, int begin, int end)
{
    const int step = BATCH / PAIRS_IN_GROUP;
    for (int k = begin; k < end; k += step)
        wet_batch(dem, k, k + step < end ? k + step : end);
}

void settle_bridges(struct dem *dem)
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
    liquid->changed = 1;
    settle_bridges(dem);
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

void form_bridges(struct dem *dem)
{
    for (int turn = 0; turn < 2; turn++) { // the second with everybody's shares
        wet_groups(dem, 0, dem->pairs.n_group);
        settle_bridges(dem);
    }
}

// Of a bridge, and least among grains that all touch as many others as find room about
// the largest: so many smallest ones at four a square of their radius.
static struct bridge_sizes sizes_of(const struct dem *dem, const struct liquid *liquid)
{
    const double small = dem->smallest_radius, large = dem->largest_radius;
    const double around = 4 * (1 + large / small) * (1 + large / small);
    const double volume = liquid->is.volume;
    return (struct bridge_sizes){{small, large},
                                 {liquid->is.shared ? 2 * volume / around : volume,
                                  liquid->is.shared ? 2 * volume : volume}};
}

// The longest gap that a bridge of any two grains can have: equal ones hold it longest
// for their effective radius, and from the smallest to the largest some are looked at.
static double longest_gap(const struct dem *dem, const struct liquid *liquid)
{
    enum { LOOKED_AT = 64 };
    const double between = 1.001; // those looked at
    const double ratio = dem->largest_radius / dem->smallest_radius;
    const double volume = (liquid->is.shared ? 2 : 1) * liquid->is.volume;
    double reach = 0;
    for (int k = 0; k <= LOOKED_AT; k++) {
        const double radius = dem->smallest_radius * pow(ratio, k / (double)LOOKED_AT);
        const double gap = rupture_gap(liquid, 0, volume / (radius * radius * radius));
        reach = fmax(reach, radius * gap);
    }
    return ratio > 1 ? between * reach : reach;
}

enum status take_liquid(struct dem *dem, const struct dem_liquid *is,
                        struct reason *reason)
{
    const double length = dem->unit.length;
    struct liquid *liquid = dem->liquid = NEW_ARRAY(struct liquid, 1);
    liquid->is = *is;
    liquid->is.surface_tension /= dem->unit.stiffness;
    liquid->is.volume /= length * length * length;
    liquid->bridges = NEW_ARRAY(int32_t, dem->n_particle);
    liquid->next = NEW_ARRAY(int32_t, dem->n_particle);
    if (is->model == BRIDGE_TABLE) {
        const struct bridge_sizes sizes = sizes_of(dem, liquid);
        const enum status status =
            bridge_ratios_create(&sizes, is->contact_angle, &liquid->table, reason);
        if (status) return status;
    }
    liquid->reach = longest_gap(dem, liquid);
    return STATUS_OK;
}

void free_liquid(struct liquid *liquid)
{
    if (!liquid) return;
    bridge_ratios_free(liquid->table);
    free(liquid->bridges);
    free(liquid->next);
    free(liquid);
}

struct dem_bridge bridge_of_pair(const struct dem *dem, int pair)
{
    if (!is_bridged(dem, pair)) return (struct dem_bridge){.volume = 0};
    const int lane = pair % PAIRS_IN_GROUP;
    const struct liquid_group *group = &dem->pairs.liquid[pair / PAIRS_IN_GROUP];
    const double length = dem->unit.length, radius = group->radius[lane] * length;
    const int32_t a = dem->identity[dem->pairs.particle[pair][0]];
    const int32_t b = dem->identity[dem->pairs.particle[pair][1]];
    return (struct dem_bridge){
        .particle = {a < b ? a : b, a < b ? b : a},
        .volume = group->volume[lane] * radius * radius * radius,
        .separation = -length * pair_geometry(dem, pair, places_ahead(dem)).overlap,
        .force = group->pull[lane] * dem->unit.stiffness * length};
}

struct dem_bridge *dem_bridges(const struct dem *dem, int *count)
{
    *count = 0;
    if (!dem->liquid) return NULL;
    struct dem_bridge *bridge = NEW_ARRAY(struct dem_bridge, dem->pairs.n_pair);
    for (int p = 0; p < dem->pairs.n_pair; p++)
        if (is_bridged(dem, p)) bridge[(*count)++] = bridge_of_pair(dem, p);
    qsort(bridge, (size_t)*count, sizeof *bridge, compare_pairs);
    return bridge;
}
