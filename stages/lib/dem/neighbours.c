// SPDX-License-Identifier: GPL-3.0-or-later
// The search for pairs that may touch before the next search: those whose surfaces are
// nearer than `skin` (Verlet's list). Bonded pairs stay in the list at any distance.
//
// A search is due when a grain may have moved half the skin. How deep the skin should
// be: with a rate of approach of two grains per cycle, searches come every skin / rate
// cycles, and a deeper skin holds more pairs to sweep. Per grain and cycle
//     cost = 4 skin + 75 rate / skin,  least at  skin = sqrt(75/4 rate).
// The rate is that since the last search. No clock is read, so every run does the same.
#include "dem/engine.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct candidates {
    int count;
    int32_t (*particle)[2]; // sorted
    int32_t *bond;          // or -1
};

// Drops the pairs of driven grains: what is prescribed does not respond, as walls do
// not to each other. Returns how many are left.
static int drop_rigid_pairs(const struct dem *dem, int32_t (*pair)[2], int count)
{
    int left = 0;
    for (int p = 0; p < count; p++)
        if (!is_driven(dem, pair[p][0]) || !is_driven(dem, pair[p][1]))
            memmove(pair[left++], pair[p], sizeof *pair);
    return left;
}

static int32_t (*find_near_pairs(const struct dem *dem, int *count))[2]
{
    struct vector *position = NEW_ARRAY(struct vector, dem->n_particle);
    double *reach = NEW_ARRAY(double, dem->n_particle);
    for (int i = 0; i < dem->n_particle; i++) {
        position[i] = position_now(dem, i);
        reach[i] = dem->place[i].radius + 0.5 * (dem->skin + bridge_cutoff(dem));
    }
    struct spheres spheres = {.count = dem->n_particle,
                              .position = position,
                              .reach = reach,
                              .threads = dem->threads};
    memcpy(spheres.lower, dem->box_lower, sizeof spheres.lower);
    memcpy(spheres.period, dem->period, sizeof spheres.period);
    int32_t(*pair)[2] = near_pairs(&spheres, count);
    if (dem->group_of) *count = drop_rigid_pairs(dem, pair, *count);
    free(position);
    free(reach);
    return pair;
}

struct bonded {
    int32_t particle[2], bond;
};

static int by_particles(const void *a, const void *b)
{
    const struct bonded *p = a, *q = b;
    const int order = compare_pairs(p->particle, q->particle);
    return order ? order : (p->bond > q->bond) - (p->bond < q->bond);
}

static struct bonded *sorted_bonds(const struct dem *dem)
{
    struct bonded *bonded = NEW_ARRAY(struct bonded, dem->n_bond);
    for (int b = 0; b < dem->n_bond; b++)
        bonded[b] =
            (struct bonded){{dem->bond_particle[b][0], dem->bond_particle[b][1]}, b};
    qsort(bonded, (size_t)dem->n_bond, sizeof *bonded, by_particles);
    return bonded;
}

// Near pairs and bonded pairs, each once, sorted.
static struct candidates find_candidates(const struct dem *dem)
{
    int n_near;
    int32_t(*near)[2] = find_near_pairs(dem, &n_near);
    struct candidates found = {.particle = near};
    if (dem->n_bond == 0) {
        found.count = n_near;
        return found;
    }
    struct bonded *bonded = sorted_bonds(dem);
    const size_t most = (size_t)n_near + (size_t)dem->n_bond;
    found.particle = allocate(most, sizeof *found.particle);
    found.bond = NEW_ARRAY(int32_t, most);
    for (int p = 0, b = 0; p < n_near || b < dem->n_bond; found.count++) {
        const int order = p == n_near ? 1
                          : b == dem->n_bond
                              ? -1
                              : compare_pairs(near[p], bonded[b].particle);
        found.bond[found.count] = order < 0 ? -1 : bonded[b].bond;
        memcpy(found.particle[found.count], order < 0 ? near[p] : bonded[b].particle,
               sizeof *found.particle);
        const int was = b;
        p += order <= 0;
        b += order >= 0;
        // A bond listed twice counts once; dem_create refuses it.
        while (b > was && b < dem->n_bond &&
               compare_pairs(bonded[b].particle, bonded[was].particle) == 0)
            b++;
    }
    free(near);
    free(bonded);
    return found;
}

// A search costs as much as sweeping some 75 pairs a grain, and the skin holds about 4
// pairs a grain for each mean radius of depth.
static const double SEARCH_COST = 75.0 / 4;

static double cycles_since_search(const struct dem *dem)
{
    return (double)(dem->cycle - dem->search_cycle);
}

// The cheapest depth (head of this file) if grains go on as fast as since the last
// search.
static double best_skin(const struct dem *dem)
{
    const double deepest = 0.6, shallowest = 0.05;
    const double rate = 2 * dem->travelled / cycles_since_search(dem);
    return fmin(fmax(sqrt(SEARCH_COST * rate), shallowest), deepest);
}

// Whether sweeping the pairs that the best skin would leave out costs more, in as many
// cycles again, than a search now.
static bool skin_is_too_deep(const struct dem *dem)
{
    const double cycles = cycles_since_search(dem);
    return dem->n_bond == 0 && cycles > 0 &&
           cycles * (dem->skin - best_skin(dem)) > SEARCH_COST;
}

static void tune_skin(struct dem *dem)
{
    if (cycles_since_search(dem) <= 0 || dem->n_bond > 0) return;
    const double best = best_skin(dem);
    double skin = fmin(best, sqrt(dem->skin * best)); // deeper only in small steps
    for (int axis = 0; axis < 3; axis++)
        if (dem->period[axis] > 0)
            skin = fmin(skin, 0.5 * dem->period[axis] - 2 * dem->largest_radius -
                                  bridge_cutoff(dem));
    dem->skin = fmax(skin, 1e-3);
}

void find_pairs(struct dem *dem)
{
    tune_skin(dem);
    close_pair_ledger(dem);
    const struct candidates found = find_candidates(dem);
    take_pairs(dem, found.count, found.particle, found.bond);
    find_wall_pairs(dem);
    for (int i = 0; i < dem->n_particle; i++)
        dem->place_at_search[i] = as_vector(dem->place[i].displacement);
    dem->travelled = dem->closed_in = 0;
    dem->search_cycle = dem->cycle;
}

bool pairs_are_due(struct dem *dem)
{
    double largest_distance = wall_travel(dem);
    const bool is_near = fmax(dem->travelled, largest_distance) <= 0.5 * dem->skin;
    if (is_near && !skin_is_too_deep(dem)) return false;
    for (int i = 0; i < dem->n_particle; i++)
        largest_distance =
            fmax(largest_distance, distance(as_vector(dem->place[i].displacement),
                                            dem->place_at_search[i]));
    // Walls approach as grains do.
    largest_distance = fmax(largest_distance + dem->closed_in, wall_travel(dem));
    dem->travelled = largest_distance;
    // So near the limit, looking again soon would cost more than a search.
    return !(largest_distance <= 0.9 * 0.5 * dem->skin) || skin_is_too_deep(dem);
}

void renew_pairs(struct dem *dem)
{
    reactivate_pairs(dem);
    enum { SEARCHES_IN_ORDER = 64 };
    if (++dem->searches_in_order > SEARCHES_IN_ORDER) renumber_grains(dem);
    find_pairs(dem);
    if (dem->step_is_automatic) shorten_time_step(dem);
}
