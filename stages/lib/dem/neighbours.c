// SPDX-License-Identifier: GPL-3.0-or-later
// Which pairs are near enough to touch before the next search. Bonded pairs stay
// whatever their distance.
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

// From grain I to J where they are now, to the nearest image.
static struct vector separation_now(const struct dem *dem, int i, int j)
{
    struct vector apart = subtract(position_now(dem, j), position_now(dem, i));
    for (int axis = 0; axis < 3; axis++) {
        const double period = dem->period[axis];
        if (period <= 0) continue;
        const double length = component(apart, axis);
        set_component(&apart, axis, length - period * rint(length / period));
    }
    return apart;
}

static int32_t (*seek_near(const struct dem *dem, int *count))[2]
{
    struct vector *position = NEW_ARRAY(struct vector, dem->n_particle);
    double *reach = NEW_ARRAY(double, dem->n_particle);
    for (int i = 0; i < dem->n_particle; i++) {
        position[i] = position_now(dem, i);
        reach[i] = dem->place[i].radius + 0.5 * (dem->skin + bridge_reach(dem));
    }
    struct spheres spheres = {.count = dem->n_particle,
                              .position = position,
                              .reach = reach,
                              .threads = dem->threads};
    memcpy(spheres.lower, dem->box_lower, sizeof spheres.lower);
    memcpy(spheres.period, dem->period, sizeof spheres.period);
    int32_t(*pair)[2] = near_pairs(&spheres, count);
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
static struct candidates seek(const struct dem *dem)
{
    int n_near;
    int32_t(*near)[2] = seek_near(dem, &n_near);
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

struct lane {
    int group, at;
};

static struct lane lane_of(int pair)
{
    return (struct lane){pair / PAIRS_IN_GROUP, pair % PAIRS_IN_GROUP};
}

void set_pair_place(const struct dem *dem, struct pair_group *group, int lane)
{
    const int i = first_grain(group, lane), j = second_grain(group, lane);
    const struct vector now = subtract(position_now(dem, j), position_now(dem, i));
    const struct vector periods = subtract(separation_now(dem, i, j), now);
    const struct vector separation =
        add(subtract(dem->start[j], dem->start[i]), periods);
    for (int axis = 0; axis < 3; axis++)
        group->separation[axis][lane] = component(separation, axis);
    const double distance = norm(separation);
    group->distance[lane] = distance;
    group->inverse_distance[lane] = 1 / distance;
    group->overlap[lane] =
        given_overlap(dem, dem->place[i].radius + dem->place[j].radius - distance);
}

void set_pair_law(struct dem *dem, int pair)
{
    const struct lane to = lane_of(pair);
    const struct contact_law law =
        pair_law(dem, dem->pairs.particle[pair][0], dem->pairs.particle[pair][1]);
    struct own_group *own = &dem->pairs.own[to.group];
    own->normal_stiffness[to.at] = law.normal_stiffness;
    own->shear_stiffness[to.at] = law.shear_stiffness;
    own->normal_damping[to.at] = law.normal_damping;
    own->shear_damping[to.at] = law.shear_damping;
    own->friction[to.at] = law.friction;
}

struct contact_law law_of_pair(const struct dem *dem, int pair)
{
    if (!dem->pairs.own) return dem->law;
    const struct lane at = lane_of(pair);
    const struct own_group *own = &dem->pairs.own[at.group];
    return (struct contact_law){.normal_stiffness = own->normal_stiffness[at.at],
                                .shear_stiffness = own->shear_stiffness[at.at],
                                .friction = own->friction[at.at],
                                .normal_damping = own->normal_damping[at.at],
                                .shear_damping = own->shear_damping[at.at]};
}

static void set_bond(struct dem *dem, struct lane to, int bond)
{
    struct bond_group *bonds = &dem->pairs.bonds[to.group];
    bonds->normal_strength[to.at] = -1;
    bonds->shear_strength[to.at] = -1;
    bonds->crack[to.at] = -1;
    if (bond < 0 || dem->bond_strength[DEM_CRACK_NORMAL][bond] < 0) return;
    const double radius = dem->bond_radius[bond];
    const double unit =
        dem->features & FEATURE_PARALLEL_BOND ? M_PI * radius * radius * radius : 1;
    bonds->radius[to.at] = radius;
    bonds->normal_strength[to.at] = unit * dem->bond_strength[DEM_CRACK_NORMAL][bond];
    bonds->shear_strength[to.at] = unit * dem->bond_strength[DEM_CRACK_SHEAR][bond];
}

void set_nobody(struct dem *dem, int pair)
{
    const struct lane to = lane_of(pair);
    struct pair_group *group = &dem->pairs.group[to.group];
    set_grains(group, to.at, dem->n_particle, dem->n_particle);
    group->separation[0][to.at] = 1;
    group->distance[to.at] = group->inverse_distance[to.at] = 1;
    group->overlap[to.at] = -1;
    if (dem->pairs.liquid) dem->pairs.liquid[to.group].radius[to.at] = 1;
    if (dem->pairs.bonds) set_bond(dem, to, -1);
}

void carry_over(struct pair_list *new, int new_pair, const struct pair_list *old,
                int old_pair, bool swapped)
{
    const struct lane to = lane_of(new_pair), from = lane_of(old_pair);
    const double sign = swapped ? -1 : 1;
    struct pair_group *group = &new->group[to.group];
    const struct pair_group *was = &old->group[from.group];
    for (int axis = 0; axis < 3; axis++) {
        group->separation[axis][to.at] = sign * was->separation[axis][from.at];
        if (new->shear)
            new->shear[to.group].force[axis][to.at] =
                sign * old->shear[from.group].force[axis][from.at];
        if (!new->bonds) continue;
        struct bond_group *bonds = &new->bonds[to.group];
        const struct bond_group *were = &old->bonds[from.group];
        bonds->shear_force[axis][to.at] = sign * were->shear_force[axis][from.at];
        bonds->bending[axis][to.at] = sign * were->bending[axis][from.at];
        bonds->twist[to.at] = were->twist[from.at];
    }
    group->distance[to.at] = was->distance[from.at];
    group->inverse_distance[to.at] = was->inverse_distance[from.at];
    group->overlap[to.at] = was->overlap[from.at];
    if (!new->liquid) return;
    struct liquid_group *liquid = &new->liquid[to.group];
    liquid->volume[to.at] = old->liquid[from.group].volume[from.at];
    liquid->rupture[to.at] = old->liquid[from.group].rupture[from.at];
}

static void fill_pairs(struct dem *dem, const struct pair_list *old)
{
    struct pair_list *pairs = &dem->pairs;
    int before = 0;
    for (int p = 0; p < pairs->n_pair; p++) {
        const struct lane to = lane_of(p);
        struct pair_group *group = &pairs->group[to.group];
        set_grains(group, to.at, pairs->particle[p][0], pairs->particle[p][1]);
        if (pairs->own) set_pair_law(dem, p);
        if (pairs->liquid) set_bridge_radius(dem, p);
        if (pairs->bonds) set_bond(dem, to, pairs->bond[p]);
        int order = -1;
        while (before < old->n_pair && order < 0) {
            order = compare_pairs(old->particle[before], pairs->particle[p]);
            before += order < 0;
        }
        if (before < old->n_pair && order == 0)
            carry_over(pairs, p, old, before, false);
        else
            set_pair_place(dem, group, to.at);
    }
    for (int p = pairs->n_pair; p < PAIRS_IN_GROUP * pairs->n_group; p++)
        set_nobody(dem, p);
}

// The pairs of each grain. As they are sorted, those of which it is the second come
// first.
static void list_pairs_of_grains(struct dem *dem)
{
    const int n = dem->n_particle, n_pair = dem->pairs.n_pair;
    memset(dem->pair_offset, 0, ((size_t)n + 1) * sizeof *dem->pair_offset);
    for (int p = 0; p < n_pair; p++)
        for (int end = 0; end < 2; end++)
            dem->pair_offset[dem->pairs.particle[p][end] + 1]++;
    for (int i = 0; i < n; i++)
        dem->pair_offset[i + 1] += dem->pair_offset[i];

    free(dem->pair_of);
    dem->pair_of = allocate(2 * (size_t)n_pair, sizeof *dem->pair_of);
    int *next = duplicate(dem->pair_offset, (size_t)n + 1, sizeof *next);
    for (int p = 0; p < n_pair; p++)
        for (int end = 0; end < 2; end++)
            dem->pair_of[next[dem->pairs.particle[p][end]]++] = p;
    free(next);
}

// Late are those with which groups of another share than the one that finishes them
// have to do.
static void find_late_grains(struct dem *dem)
{
    const int share = groups_in_share(dem);
    dem->n_late = 0;
    for (int i = 0; i < dem->n_particle; i++) {
        dem->is_late[i] = dem->last_group[i] >= 0 &&
                          dem->first_group[i] / share < dem->last_group[i] / share;
        if (dem->is_late[i]) dem->late[dem->n_late++] = i;
    }
}

// Late grains get a row for each of their pairs, behind the others; how many rows there
// are in all.
static int number_late_rows(struct dem *dem)
{
    int row = dem->n_particle + 1;
    for (int k = 0; k < dem->n_late; k++) {
        const int i = dem->late[k];
        dem->late_row[k] = row;
        row += dem->pair_offset[i + 1] - dem->pair_offset[i];
    }
    dem->late_row[dem->n_late] = row;
    return row;
}

static void assign_rows(struct dem *dem)
{
    int32_t *row = NEW_ARRAY(int32_t, dem->n_particle + 1);
    for (int i = 0; i <= dem->n_particle; i++)
        row[i] = i;
    for (int k = 0; k < dem->n_late; k++)
        row[dem->late[k]] = dem->late_row[k];
    for (int k = 0; k < dem->pairs.n_group; k++)
        for (int at = 0; at < PAIRS_IN_GROUP; at++)
            for (int end = 0; end < 2; end++) {
                const struct pair_group *group = &dem->pairs.group[k];
                struct sum_group *sum = &dem->pairs.sum[k];
                const int i = end ? second_grain(group, at) : first_grain(group, at);
                (end ? sum->second : sum->first)[at] = NUMBER_STEP * (uint32_t)row[i];
                if (row[i] == i) continue;
                dem->pairs.elsewhere[k] = true;
                row[i]++;
            }
    free(row);
}

static void assign_sums(struct dem *dem)
{
    const bool is_large = dem->pairs.n_pair > LEAST_TO_SHARE;
    dem->n_share = is_large ? dem->threads : 1;
    find_late_grains(dem);
    const size_t rows = (size_t)number_late_rows(dem);
    assign_rows(dem);
    free(dem->sum);
    dem->sum = allocate_aligned(rows * (dem->features & FEATURE_TURN ? 8 : 4),
                                sizeof *dem->sum);
}

// When each grain may move; see engine.h.
static void assign_groups(struct dem *dem)
{
    for (int i = 0; i < dem->n_particle; i++) {
        dem->first_group[i] = dem->pairs.n_group;
        dem->last_group[i] = -1;
    }
    for (int p = dem->pairs.n_pair - 1; p >= 0; p--)
        for (int end = 0; end < 2; end++)
            dem->first_group[dem->pairs.particle[p][end]] = p / PAIRS_IN_GROUP;
    for (int p = 0; p < dem->pairs.n_pair; p++)
        dem->last_group[dem->pairs.particle[p][0]] = p / PAIRS_IN_GROUP;
    for (int i = 1; i < dem->n_particle; i++)
        if (dem->last_group[i] < dem->last_group[i - 1])
            dem->last_group[i] = dem->last_group[i - 1];
}

// Lists of what the scene needs, and of nothing else.
void new_pairs(struct dem *dem, int n_pair, int32_t (*particle)[2], int32_t *bond)
{
    const int n_group = (n_pair + PAIRS_IN_GROUP - 1) / PAIRS_IN_GROUP;
    const size_t n = (size_t)n_group;
    struct pair_list *pairs = &dem->pairs;
    *pairs = (struct pair_list){.n_pair = n_pair,
                                .particle = particle,
                                .bond = bond,
                                .n_group = n_group,
                                .group = allocate_aligned(n, sizeof *pairs->group),
                                .sum = allocate_aligned(n, sizeof *pairs->sum),
                                .load = allocate_aligned(n, sizeof *pairs->load),
                                .elsewhere = NEW_ARRAY(uint8_t, n),
                                .idle = NEW_ARRAY(uint8_t, n)};
    if (dem->features & FEATURE_TURN) {
        pairs->moment = allocate_aligned(n, sizeof *pairs->moment);
        pairs->shear = allocate_aligned(n, sizeof *pairs->shear);
    }
    if (dem->features & FEATURE_OWN)
        pairs->own = allocate_aligned(n, sizeof *pairs->own);
    if (dem->features & FEATURE_BOND)
        pairs->bonds = allocate_aligned(n, sizeof *pairs->bonds);
    if (dem->balance_energy) pairs->loss = allocate_aligned(n, sizeof *pairs->loss);
    if (dem->liquid) pairs->liquid = allocate_aligned(n, sizeof *pairs->liquid);
}

void free_pairs(struct pair_list *pairs)
{
    free(pairs->particle);
    free(pairs->bond);
    free(pairs->group);
    free(pairs->sum);
    free(pairs->load);
    free(pairs->elsewhere);
    free(pairs->idle);
    free(pairs->moment);
    free(pairs->shear);
    free(pairs->own);
    free(pairs->bonds);
    free(pairs->loss);
    free(pairs->liquid);
}

void close_pair_books(struct dem *dem)
{
    if (!dem->pairs.loss) return;
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const struct lane at = lane_of(p);
        const struct loss_group *loss = &dem->pairs.loss[at.group];
        dem->books.dashpots += loss->dashpots[at.at];
        dem->books.slip += loss->slip[at.at];
        dem->books.broken += loss->broken[at.at];
        dem->books.bridges += loss->bridges[at.at];
    }
    memset(dem->pairs.loss, 0, (size_t)dem->pairs.n_group * sizeof *dem->pairs.loss);
}

// A search costs as much as sweeping some 75 pairs a grain, and the next layer of the
// skin holds about 4 pairs a grain for each radius of depth.
static const double search_over_pairs = 75.0 / 4;

static double cycles_since_search(const struct dem *dem)
{
    return (double)(dem->cycle - dem->search_cycle);
}

// The depth that makes sweeping and searching together cheapest if grains go on as fast
// as they did since the last search. No clock is asked, so that every run does the
// same.
static double best_skin(const struct dem *dem)
{
    const double deepest = 0.6, shallowest = 0.05;
    const double rate = 2 * dem->travelled / cycles_since_search(dem);
    return fmin(fmax(sqrt(search_over_pairs * rate), shallowest), deepest);
}

// Whether the pairs that the best skin would spare in as many cycles again cost more
// than a search now.
static bool skin_is_too_deep(const struct dem *dem)
{
    const double cycles = cycles_since_search(dem);
    return dem->n_bond == 0 && cycles > 0 &&
           cycles * (dem->skin - best_skin(dem)) > search_over_pairs;
}

static void tune_skin(struct dem *dem)
{
    if (cycles_since_search(dem) <= 0 || dem->n_bond > 0) return;
    const double best = best_skin(dem);
    double skin = fmin(best, sqrt(dem->skin * best)); // deeper in small steps only
    for (int axis = 0; axis < 3; axis++)
        if (dem->period[axis] > 0)
            skin = fmin(skin, 0.5 * dem->period[axis] - 2 * dem->largest_radius -
                                  bridge_reach(dem));
    dem->skin = fmax(skin, 1e-3);
}

void arrange_sums(struct dem *dem)
{
    assign_groups(dem);
    assign_sums(dem);
}

void take_pairs(struct dem *dem, int n_pair, int32_t (*particle)[2], int32_t *bond)
{
    struct pair_list old = dem->pairs;
    new_pairs(dem, n_pair, particle, bond);
    fill_pairs(dem, &old);
    free_pairs(&old);
    list_pairs_of_grains(dem);
    arrange_sums(dem);
    if (dem->liquid) count_bridges(dem);
}

void find_pairs(struct dem *dem)
{
    tune_skin(dem);
    close_pair_books(dem);
    const struct candidates found = seek(dem);
    take_pairs(dem, found.count, found.particle, found.bond);
    find_wall_pairs(dem);
    for (int i = 0; i < dem->n_particle; i++)
        dem->place_at_search[i] = as_vector(dem->place[i].displacement);
    dem->travelled = dem->closed_in = 0;
    dem->search_cycle = dem->cycle;
}

bool pairs_are_due(struct dem *dem)
{
    double furthest = wall_travel(dem);
    const bool is_near = fmax(dem->travelled, furthest) <= 0.5 * dem->skin;
    if (is_near && !skin_is_too_deep(dem)) return false;
    for (int i = 0; i < dem->n_particle; i++)
        furthest = fmax(furthest, distance(as_vector(dem->place[i].displacement),
                                           dem->place_at_search[i]));
    // Walls come as near as grains.
    furthest = fmax(furthest + dem->closed_in, wall_travel(dem));
    dem->travelled = furthest;
    // So near the limit that looking again soon would cost more than a search.
    return !(furthest <= 0.9 * 0.5 * dem->skin) || skin_is_too_deep(dem);
}

void renew_pairs(struct dem *dem)
{
    wake_pairs(dem);
    enum { SEARCHES_IN_ORDER = 64 };
    if (++dem->searches_in_order > SEARCHES_IN_ORDER) renumber_grains(dem);
    find_pairs(dem);
    if (dem->step_is_automatic) shorten_time_step(dem);
}
