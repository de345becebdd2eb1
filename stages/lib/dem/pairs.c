// SPDX-License-Identifier: GPL-3.0-or-later
// The list of pairs in groups of eight: where each lies, its coefficients, and its
// history carried from list to list.
//
// A pair (i, j), i < j, remembers the separation x_j - x_i of the places where both
// began (nearest periodic image), its length and the overlap there. Displacements are
// added to that, so a small overlap keeps its digits. Both lists are sorted, so
// histories go over in one merge. A pair whose grains change order changes the sign of
// its vectors.
#include "dem/engine.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Separation from grain I to J now, to the nearest image. For geometry only, as
// position_now rounds.
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

struct lane {
    int group, at;
};

static struct lane lane_of(int pair)
{
    return (struct lane){pair / PAIRS_IN_GROUP, pair % PAIRS_IN_GROUP};
}

// `periods` is a whole number of box edges, exact but for the rounding of one
// subtraction; added to the difference of the starts it keeps their digits.
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
    const double lost = shrunk_by(dem, i) + shrunk_by(dem, j);
    const double radii = dem->place[i].radius + dem->place[j].radius + lost;
    group->overlap[lane] = given_overlap(dem, radii - distance) - lost;
}

void set_pair_law(struct dem *dem, int pair)
{
    const struct lane to = lane_of(pair);
    const struct contact_law law =
        pair_law(dem, dem->pairs.particle[pair][0], dem->pairs.particle[pair][1]);
    struct law_group *laws = &dem->pairs.laws[to.group];
    laws->normal_stiffness[to.at] = law.normal_stiffness;
    laws->shear_stiffness[to.at] = law.shear_stiffness;
    laws->normal_damping[to.at] = law.normal_damping;
    laws->shear_damping[to.at] = law.shear_damping;
    laws->friction[to.at] = law.friction;
}

struct contact_law law_of_pair(const struct dem *dem, int pair)
{
    if (!dem->pairs.laws) return dem->law;
    const struct lane at = lane_of(pair);
    const struct law_group *laws = &dem->pairs.laws[at.group];
    return (struct contact_law){.normal_stiffness = laws->normal_stiffness[at.at],
                                .shear_stiffness = laws->shear_stiffness[at.at],
                                .friction = laws->friction[at.at],
                                .normal_damping = laws->normal_damping[at.at],
                                .shear_damping = laws->shear_damping[at.at]};
}

// Strengths times A R = pi R^3 for parallel bonds (pair_bond.h). A broken bond leaves
// -1.
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

// At a distance of 1, so that nothing is divided by 0, and an overlap of -1, so that
// nothing acts.
void set_dummy_pair(struct dem *dem, int pair)
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

// The coefficients are not carried: they follow from the grains, whose radii may have
// changed.
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
        if (new->rolling)
            new->rolling[to.group].moment[axis][to.at] =
                sign * old->rolling[from.group].moment[axis][from.at];
        if (!new->bonds) continue;
        struct bond_group *bonds = &new->bonds[to.group];
        const struct bond_group *were = &old->bonds[from.group];
        bonds->shear_force[axis][to.at] = sign * were->shear_force[axis][from.at];
        bonds->bending[axis][to.at] = sign * were->bending[axis][from.at];
        bonds->twist[to.at] = were->twist[from.at];
        bonds->free_stretch[to.at] = were->free_stretch[from.at];
    }
    group->distance[to.at] = was->distance[from.at];
    group->inverse_distance[to.at] = was->inverse_distance[from.at];
    group->overlap[to.at] = was->overlap[from.at];
    if (!new->liquid) return;
    struct liquid_group *liquid = &new->liquid[to.group];
    liquid->volume[to.at] = old->liquid[from.group].volume[from.at];
    liquid->rupture[to.at] = old->liquid[from.group].rupture[from.at];
}

// The first of the sorted pairs of OLD that does not come before PAIR.
static int first_old_pair(const struct pair_list *old, const int32_t pair[2])
{
    int low = 0, high = old->n_pair;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (compare_pairs(old->particle[middle], pair) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// Pairs BEGIN..END-1. Both lists are sorted by first, then second grain: `before` only
// goes forward.
static void fill_range(struct dem *dem, const struct pair_list *old, int begin, int end)
{
    struct pair_list *pairs = &dem->pairs;
    int before = first_old_pair(old, pairs->particle[begin]);
    for (int p = begin; p < end; p++) {
        const struct lane to = lane_of(p);
        struct pair_group *group = &pairs->group[to.group];
        set_grains(group, to.at, pairs->particle[p][0], pairs->particle[p][1]);
        if (pairs->laws) set_pair_law(dem, p);
        if (pairs->rolling)
            set_pair_rolling(dem, p, law_of_pair(dem, p).normal_stiffness);
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
}

static void fill_pairs(struct dem *dem, const struct pair_list *old)
{
    enum { SHARE = 4096 }; // whole groups
    const int n = dem->pairs.n_pair;
#pragma omp parallel for num_threads(dem->threads) schedule(dynamic, 1) if (n > SHARE)
    for (int begin = 0; begin < n; begin += SHARE)
        fill_range(dem, old, begin, begin + SHARE < n ? begin + SHARE : n);
    for (int p = n; p < PAIRS_IN_GROUP * dem->pairs.n_group; p++)
        set_dummy_pair(dem, p);
}

// Where an array lies in the block of a list: from a cache line on.
struct carving {
    char *block; // NULL: only how much it takes
    size_t used;
};

static void *carve(struct carving *from, size_t count, size_t size)
{
    void *array = from->block ? from->block + from->used : NULL;
    from->used += (count * size + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE;
    return array;
}

// Gives the arrays of N groups their places, first those that begin as 0; returns how
// many bytes these take.
static size_t lay_out(const struct dem *dem, struct pair_list *pairs, size_t n,
                      struct carving *from)
{
    pairs->load = carve(from, n, sizeof *pairs->load);
    pairs->idle = carve(from, n, sizeof *pairs->idle);
    if (dem->features & FEATURE_ROTATION) {
        pairs->moment = carve(from, n, sizeof *pairs->moment);
        pairs->shear = carve(from, n, sizeof *pairs->shear);
    }
    if (dem->features & FEATURE_BOND)
        pairs->bonds = carve(from, n, sizeof *pairs->bonds);
    if (dem->balance_energy) pairs->loss = carve(from, n, sizeof *pairs->loss);
    if (dem->features & FEATURE_ROLLING)
        pairs->rolling = carve(from, n, sizeof *pairs->rolling);
    if (dem->liquid) pairs->liquid = carve(from, n, sizeof *pairs->liquid);
    const size_t cleared = from->used;
    pairs->group = carve(from, n, sizeof *pairs->group);
    pairs->sum = carve(from, n, sizeof *pairs->sum);
    pairs->has_shared_grain = carve(from, n, sizeof *pairs->has_shared_grain);
    if (dem->features & FEATURE_PAIR_LAWS)
        pairs->laws = carve(from, n, sizeof *pairs->laws);
    return cleared;
}

// A block of BYTES or more, the one that the last list has left if it is large enough:
// fresh pages from the kernel would cost as much as the search itself.
static void *take_block(struct dem *dem, size_t bytes, size_t *size)
{
    void *block = dem->spare_block;
    *size = dem->spare_size;
    dem->spare_block = NULL;
    dem->spare_size = 0;
    if (block && *size >= bytes) return block;
    free(block);
    *size = bytes + bytes / 8; // lists of the next searches may be longer
    return allocate_uncleared(*size, 1);
}

// Allocates what the scene needs, and nothing else.
void new_pairs(struct dem *dem, int n_pair, int32_t (*particle)[2], int32_t *bond)
{
    const int n_group = (n_pair + PAIRS_IN_GROUP - 1) / PAIRS_IN_GROUP;
    const size_t n = (size_t)n_group;
    struct pair_list *pairs = &dem->pairs;
    *pairs = (struct pair_list){
        .n_pair = n_pair, .particle = particle, .bond = bond, .n_group = n_group};
    struct carving from = {NULL, 0};
    lay_out(dem, pairs, n, &from);
    pairs->block = take_block(dem, from.used, &pairs->block_size);
    from = (struct carving){pairs->block, 0};
    memset(pairs->block, 0, lay_out(dem, pairs, n, &from));
    if (n == 0) return;
    memset(&pairs->group[n - 1], 0, sizeof *pairs->group); // lanes that hold no pair
    if (pairs->laws) memset(&pairs->laws[n - 1], 0, sizeof *pairs->laws);
}

void free_pairs(struct pair_list *pairs)
{
    free(pairs->particle);
    free(pairs->bond);
    free(pairs->block);
}

void give_back_pairs(struct dem *dem, struct pair_list *pairs)
{
    if (pairs->block_size > dem->spare_size) {
        free(dem->spare_block);
        dem->spare_block = pairs->block;
        dem->spare_size = pairs->block_size;
        pairs->block = NULL;
    }
    free_pairs(pairs);
}

// In the order of pairs, so that the sum does not depend on threads.
void close_pair_ledger(struct dem *dem)
{
    if (!dem->pairs.loss) return;
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const struct lane at = lane_of(p);
        const struct loss_group *loss = &dem->pairs.loss[at.group];
        dem->energy_ledger.dashpots += loss->dashpots[at.at];
        dem->energy_ledger.slip += loss->slip[at.at];
        dem->energy_ledger.broken += loss->broken[at.at];
        dem->energy_ledger.bridges += loss->bridges[at.at];
    }
    memset(dem->pairs.loss, 0, (size_t)dem->pairs.n_group * sizeof *dem->pairs.loss);
}

// Lists the pairs of each grain. As pairs are sorted, those of which it is the second
// come first. Counting sort: pair_of[pair_offset[i]] on are the pairs of grain i.
static void list_pairs_of_grains(struct dem *dem)
{
    const int n = dem->n_particle, n_pair = dem->pairs.n_pair;
    memset(dem->pair_offset, 0, ((size_t)n + 1) * sizeof *dem->pair_offset);
    for (int p = 0; p < n_pair; p++)
        for (int end = 0; end < 2; end++)
            dem->pair_offset[dem->pairs.particle[p][end] + 1]++;
    for (int i = 0; i < n; i++)
        dem->pair_offset[i + 1] += dem->pair_offset[i];

    if (n_pair > dem->pair_of_room) {
        dem->pair_of_room = n_pair + n_pair / 8;
        free(dem->pair_of);
        dem->pair_of = NEW_ARRAY(int32_t, 2 * (size_t)dem->pair_of_room);
    }
    int *next = duplicate(dem->pair_offset, (size_t)n + 1, sizeof *next);
    for (int p = 0; p < n_pair; p++)
        for (int end = 0; end < 2; end++)
            dem->pair_of[next[dem->pairs.particle[p][end]]++] = p;
    free(next);
}

void take_pairs(struct dem *dem, int n_pair, int32_t (*particle)[2], int32_t *bond)
{
    struct pair_list old = dem->pairs;
    new_pairs(dem, n_pair, particle, bond);
    fill_pairs(dem, &old);
    give_back_pairs(dem, &old);
    list_pairs_of_grains(dem);
    arrange_sums(dem);
    if (dem->liquid) count_bridges(dem);
}
