// SPDX-License-Identifier: GPL-3.0-or-later
// The search for pairs that may touch before the next search: those whose surfaces are
// nearer than the mean of their skins (Verlet's list). Bonded pairs stay in the list at
// any distance.
//
// A search is due when a grain may have moved by half of its skin. Most grains of a bed
// that comes to rest hardly move, and some topple, so each has a skin of its own: with
// the speed v when pairs are sought, in radii a cycle,
//     skin_i = s + 2 v_i T,
// T the cycles until the next search, and s for what speeds do not foretell. Grains
// moved by at most r/2 a cycle more than that since the last search, so s = r T. Deeper
// skins hold more pairs to sweep. Per grain and cycle
//     cost = 4 mean skin + 75 / T,  least at  T = sqrt(75/4 / (r + 2 mean v)).
// No clock is read, so every run does the same.
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
        reach[i] = dem->place[i].radius + dem->half_skin[i] + 0.5 * bridge_cutoff(dem);
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

// In mean radii. The deepest skin makes the cells of the search as wide for all grains.
static const double SHALLOWEST = 0.05, DEEPEST = 0.6;

// What the box leaves room for, where it repeats.
static double deepest_skin(const struct dem *dem)
{
    double deepest = DEEPEST;
    for (int axis = 0; axis < 3; axis++)
        if (dem->period[axis] > 0)
            deepest = fmin(deepest, 0.5 * dem->period[axis] - 2 * dem->largest_radius -
                                        bridge_cutoff(dem));
    return fmax(deepest, 1e-3);
}

static double travel(const struct dem *dem, int i)
{
    return distance(as_vector(dem->place[i].displacement), dem->place_at_search[i]);
}

static double speed(const struct dem *dem, int i)
{
    return dem->time_step * norm(as_vector(velocity_of(dem, i)));
}

// How fast two grains approached since the last search, beyond what skins foresaw.
static double unforeseen_rate(const struct dem *dem)
{
    const double cycles = cycles_since_search(dem);
    const double elapsed = dem->horizon > 0 ? fmin(cycles / dem->horizon, 1) : 0;
    double most = wall_travel(dem);
    for (int i = 0; i < dem->n_particle; i++) {
        const double foreseen = elapsed * (dem->half_skin[i] - 0.5 * dem->skin);
        most = fmax(most, travel(dem, i) + dem->closed_in - foreseen);
    }
    return 2 * most / cycles;
}

// Skins of grains that go on at their speeds, for T cycles.
static void set_skins(struct dem *dem)
{
    const double deepest = deepest_skin(dem);
    dem->skin = fmin(dem->skin, deepest);
    double sum = 0;
    for (int i = 0; i < dem->n_particle; i++) {
        const double deep = 0.5 * dem->skin + speed(dem, i) * dem->horizon;
        dem->half_skin[i] = fmin(deep, 0.5 * deepest);
        sum += dem->half_skin[i];
    }
    dem->mean_skin = dem->n_particle > 0 ? 2 * sum / dem->n_particle : dem->skin;
}

// T and s at the least cost (head of this file).
static void tune_skins(struct dem *dem)
{
    if (cycles_since_search(dem) <= 0 || dem->n_bond > 0) return;
    double mean_speed = 0;
    for (int i = 0; i < dem->n_particle; i++)
        mean_speed += speed(dem, i) / dem->n_particle;
    const double rate = unforeseen_rate(dem), slowest = 1e-12;
    dem->horizon = sqrt(SEARCH_COST / fmax(rate + 2 * mean_speed, slowest));
    const double best = rate * dem->horizon;
    const double skin = fmin(best, sqrt(dem->skin * best)); // deeper in small steps
    dem->skin = fmax(skin, SHALLOWEST);
}

// Whether sweeping the pairs that shallower skins would leave out costs more, in as
// many cycles again, than a search now: at the pace so far, skins of a share F of these
// last F cycles / used, and cost = 4 F mean skin + 75 used / (F cycles) is least at F.
static bool skins_are_too_deep(const struct dem *dem)
{
    const double cycles = cycles_since_search(dem);
    const double least =
        fmax(SHALLOWEST / dem->mean_skin,
             sqrt(SEARCH_COST * dem->used / (cycles * dem->mean_skin)));
    return dem->n_bond == 0 && cycles > 0 &&
           cycles * dem->mean_skin * (1 - least) > SEARCH_COST;
}

void find_pairs(struct dem *dem)
{
    tune_skins(dem);
    set_skins(dem);
    close_pair_ledger(dem);
    const struct candidates found = find_candidates(dem);
    take_pairs(dem, found.count, found.particle, found.bond);
    find_wall_pairs(dem);
    for (int i = 0; i < dem->n_particle; i++)
        dem->place_at_search[i] = as_vector(dem->place[i].displacement);
    dem->used = dem->closed_in = 0;
    dem->search_cycle = dem->cycle;
}

void count_approach(struct dem *dem, double distance)
{
    dem->closed_in += distance;
    dem->used += distance / (0.5 * dem->skin);
}

bool pairs_are_due(struct dem *dem)
{
    const double walls = wall_travel(dem) / (0.5 * dem->skin);
    const bool is_near = fmax(dem->used, walls) <= 1;
    if (is_near && !skins_are_too_deep(dem)) return false;
    double largest_share = 0;
    for (int i = 0; i < dem->n_particle; i++)
        largest_share = fmax(largest_share, travel(dem, i) / dem->half_skin[i]);
    // Walls approach as grains do.
    dem->used = fmax(largest_share + dem->closed_in / (0.5 * dem->skin), walls);
    // So near the limit, looking again soon would cost more than a search.
    return !(dem->used <= 0.9) || skins_are_too_deep(dem);
}

void renew_pairs(struct dem *dem)
{
    reactivate_pairs(dem);
    enum { SEARCHES_IN_ORDER = 64 };
    if (++dem->searches_in_order > SEARCHES_IN_ORDER) renumber_grains(dem);
    find_pairs(dem);
    if (dem->step_is_automatic) shorten_time_step(dem);
}
