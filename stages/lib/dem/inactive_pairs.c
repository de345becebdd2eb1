// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs that rest: neither bonded nor near enough to touch, or of two grains that are
// fixed. They do nothing to any grain, and are a third of all when half of the bonds
// have broken. So while many cycles are run they are left out of the list that is
// swept, and each cycle only asks whether two of them may touch. The others keep their
// order, and what is left out of a sum is zero, so the bytes are those of the whole
// list.
//
// The whole list is swept again in the last cycle, which leaves the loads of all pairs.
#include "dem/engine.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

typedef double quad __attribute__((vector_size(32)));

// Two grains apart: they may touch when they are as near as REACH.
struct apart {
    quad separation; // where they began; the fourth is the first radius less the second
    double reach_square;
    int32_t particle[2];
};

struct resting {
    struct pair_list all;
    int32_t *number; // (of those swept) in ALL
    int n_apart;
    struct apart *apart;
    double largest_reach;
    double room; // so much nearer two of them may come before any may touch
};

// A gap may be misjudged by so much of the distance, for rounding.
static const double margin = 1e-9;

static bool are_fixed(const struct dem *dem, const int32_t particle[2])
{
    return dem->mobility[particle[0]][0] <= 0 && dem->mobility[particle[1]][0] <= 0;
}

static double touching_distance(const struct pair_list *pairs, int pair)
{
    const struct pair_group *group = &pairs->group[pair / PAIRS_IN_GROUP];
    const int lane = pair % PAIRS_IN_GROUP;
    return group->distance[lane] + group->overlap[lane];
}

static double distance_square(const struct place *place, const struct apart *apart)
{
    const quad *first = (const quad *)&place[apart->particle[0]];
    const quad *second = (const quad *)&place[apart->particle[1]];
    const quad separation = apart->separation + (*second - *first);
    const quad square = separation * separation;
    return square[0] + square[1] + square[2];
}

static struct apart apart_of(const struct dem *dem, int pair)
{
    const int32_t *end = dem->pairs.particle[pair];
    const struct vector start = lane_vector(
        dem->pairs.group[pair / PAIRS_IN_GROUP].separation, pair % PAIRS_IN_GROUP);
    const double reach = (1 + margin) * touching_distance(&dem->pairs, pair);
    return (struct apart){
        .separation = {start.x, start.y, start.z,
                       dem->place[end[0]].radius - dem->place[end[1]].radius},
        .reach_square = reach * reach,
        .particle = {end[0], end[1]}};
}

// As the next sweep would make it.
static void forget_shear(struct pair_list *pairs, int pair)
{
    for (int axis = 0; axis < 3; axis++)
        pairs->shear[pair / PAIRS_IN_GROUP].force[axis][pair % PAIRS_IN_GROUP] = 0;
}

// Notes those that are apart by more than the least gap, and the numbers of those that
// do not rest; how many these are.
static int part(struct dem *dem, struct resting *resting)
{
    int n = 0;
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const int32_t *end = dem->pairs.particle[p];
        if (are_fixed(dem, end)) continue;
        if (!is_held(dem, p)) {
            const struct apart apart = apart_of(dem, p);
            const double least =
                (1 + 2 * margin) * touching_distance(&dem->pairs, p) + dem->least_gap;
            if (distance_square(dem->place, &apart) > least * least) {
                resting->apart[resting->n_apart++] = apart;
                resting->largest_reach =
                    fmax(resting->largest_reach, sqrt(apart.reach_square));
                forget_shear(&dem->pairs, p);
                continue;
            }
        }
        resting->number[n++] = p;
    }
    return n;
}

// ROWS numbers of one lane.
static void copy_rows(void *to, int to_pair, const void *from, int from_pair,
                      size_t group, size_t offset, int rows)
{
    const size_t there = (size_t)to_pair / PAIRS_IN_GROUP * group + offset;
    const size_t here = (size_t)from_pair / PAIRS_IN_GROUP * group + offset;
    double *a = (double *)((char *)to + there) + to_pair % PAIRS_IN_GROUP;
    const double *b =
        (const double *)((const char *)from + here) + from_pair % PAIRS_IN_GROUP;
    for (int k = 0; k < rows; k++)
        a[k * PAIRS_IN_GROUP] = b[k * PAIRS_IN_GROUP];
}

#define COPY(groups, type, member, rows)                                               \
    copy_rows(to->groups, to_pair, from->groups, from_pair, sizeof(type),              \
              offsetof(type, member), rows)

// What sweeps change.
static void copy_history(struct pair_list *to, int to_pair,
                         const struct pair_list *from, int from_pair)
{
    COPY(shear, struct shear_group, force, 3);
    COPY(bonds, struct bond_group, radius, 3);
    COPY(bonds, struct bond_group, shear_force, 7);
}

static void copy_pair(struct pair_list *to, int to_pair, const struct pair_list *from,
                      int from_pair)
{
    for (int end = 0; end < 2; end++)
        to->particle[to_pair][end] = from->particle[from_pair][end];
    to->bond[to_pair] = from->bond[from_pair];
    COPY(group, struct pair_group, separation, 6);
    if (to->own) COPY(own, struct own_group, normal_stiffness, 5);
    copy_history(to, to_pair, from, from_pair);
}

static void sweep_only(struct dem *dem, const struct resting *resting, int n)
{
    new_pairs(dem, n, allocate((size_t)n, 2 * sizeof(int32_t)), NEW_ARRAY(int32_t, n));
    struct pair_list *pairs = &dem->pairs;
    for (int p = 0; p < n; p++) {
        copy_pair(pairs, p, &resting->all, resting->number[p]);
        struct pair_group *group = &pairs->group[p / PAIRS_IN_GROUP];
        set_grains(group, p % PAIRS_IN_GROUP, pairs->particle[p][0],
                   pairs->particle[p][1]);
        pairs->bonds[p / PAIRS_IN_GROUP].crack[p % PAIRS_IN_GROUP] = -1;
    }
    for (int p = n; p < PAIRS_IN_GROUP * pairs->n_group; p++)
        set_nobody(dem, p);
    arrange_sums(dem);
}

static void free_resting(struct resting *resting)
{
    free(resting->number);
    free(resting->apart);
    free(resting);
}

static void rest(struct dem *dem)
{
    enum { WORTH_IT = 16 }; // one in so many
    const int n = dem->pairs.n_pair;
    struct resting *resting = NEW_ARRAY(struct resting, 1);
    resting->number = NEW_ARRAY(int32_t, n);
    resting->apart = allocate_aligned((size_t)n, sizeof *resting->apart);
    const int n_swept = part(dem, resting);
    if (n - n_swept < n / WORTH_IT) {
        free_resting(resting);
        return;
    }
    resting->all = dem->pairs;
    dem->resting = resting;
    sweep_only(dem, resting, n_swept);
}

void wake_pairs(struct dem *dem)
{
    struct resting *resting = dem->resting;
    if (!resting) return;
    for (int p = 0; p < dem->pairs.n_pair; p++)
        copy_history(&resting->all, resting->number[p], &dem->pairs, p);
    free_pairs(&dem->pairs);
    dem->pairs = resting->all;
    dem->resting = NULL;
    free_resting(resting);
    arrange_sums(dem);
}

// Two that are apart by d with d^2 - reach^2 >= LEAST, the least there is, have room
// for d - reach, which is least where the reach is largest.
static double room_of(const struct resting *resting, double least)
{
    const double reach = resting->largest_reach;
    return least / (sqrt(reach * reach + least) + reach);
}

static bool any_may_touch(const struct dem *dem)
{
    struct resting *resting = dem->resting;
    resting->room -= 2 * dem->last_travel;
    if (resting->room > 0) return false;
    double least = INFINITY;
    for (int k = 0; k < resting->n_apart; k++) {
        const struct apart *apart = &resting->apart[k];
        const double beyond = distance_square(dem->place, apart) - apart->reach_square;
        least = beyond < least ? beyond : least;
    }
    if (!(least > 0)) return true;
    resting->room = room_of(resting, least);
    return false;
}

// Not before every pair has been swept once: of two fixed grains, too, a bond without
// strength breaks then. Losses are kept by pair, and bridges reach over gaps.
static bool may_rest(const struct dem *dem)
{
    return dem->features & FEATURE_PARALLEL_BOND && !dem->liquid && !dem->pairs.loss &&
           dem->cycle > 0;
}

void rest_or_wake(struct dem *dem, int64_t left, bool begins)
{
    enum { LEAST_CYCLES = 64 }; // fewer are not worth another list
    const bool disturbed = dem->resting && any_may_touch(dem);
    if (disturbed || left == 1) wake_pairs(dem);
    // Waking costs a few cycles: it should come about once in two hundred.
    if (disturbed) dem->least_gap = fmin(1.5 * dem->least_gap, 1e-2);
    if (begins) dem->least_gap = fmax(0.5 * dem->least_gap, 1e-7);
    if ((begins || disturbed) && left >= LEAST_CYCLES && may_rest(dem)) rest(dem);
}
