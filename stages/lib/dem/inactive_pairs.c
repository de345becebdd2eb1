// SPDX-License-Identifier: GPL-3.0-or-later
// Inactive pairs: neither bonded nor near enough to touch, or of two fixed grains. They
// act on no grain, and are a third of all pairs when half of the bonds have broken. So
// in a long run they are left out of the list that is swept. Each cycle only asks
// whether any two of them may touch.
//
// A pair with cutoff c (the distance at which it touches) and distance d has the slack
//     d - c = (d^2 - c^2) / (d + c) >= least / (sqrt(c^2 + least) + c),
// where `least` is the smallest d^2 - c^2 of all and c the largest cutoff. In a cycle
// two grains approach by at most 2 last_travel. So the distances are looked at again
// only when the travel has used up the slack.
//
// The others keep their order and a left-out pair adds zero, so the bytes are those of
// the whole list. The whole list is swept in the last cycle, which leaves the loads of
// all pairs.
#include "dem/engine.h"

#include "basics/memory.h"
#include "basics/simd.h"

#include <math.h>
#include <stdlib.h>

// Two grains apart: they may touch when their distance is CUTOFF or less.
struct distant_pair {
    double4
        separation; // where they began; the fourth is the first radius less the second
    double cutoff_square;
    int32_t particle[2];
};

struct inactive_pairs {
    struct pair_list all;
    int32_t *index; // (of those swept) in ALL
    int n_distant;
    struct distant_pair *distant;
    double largest_cutoff;
    double slack; // two may approach by this much before any pair touches
};

// A gap may be misjudged by so much of the distance, for rounding.
static const double MARGIN = 1e-9;

static bool are_fixed(const struct dem *dem, const int32_t particle[2])
{
    bool fixed = true;
    for (int k = 0; k < 2; k++)
        fixed =
            fixed && dem->mobility[particle[k]][0] <= 0 && !is_driven(dem, particle[k]);
    return fixed;
}

static double touching_distance(const struct pair_list *pairs, int pair)
{
    const struct pair_group *group = &pairs->group[pair / PAIRS_IN_GROUP];
    const int lane = pair % PAIRS_IN_GROUP;
    return group->distance[lane] + group->overlap[lane];
}

static double distance_square(const struct place *place,
                              const struct distant_pair *distant)
{
    const double4 *first = (const double4 *)&place[distant->particle[0]];
    const double4 *second = (const double4 *)&place[distant->particle[1]];
    const double4 separation = distant->separation + (*second - *first);
    const double4 square = separation * separation;
    return square[0] + square[1] + square[2];
}

static struct distant_pair distant_pair_of(const struct dem *dem, int pair)
{
    const int32_t *end = dem->pairs.particle[pair];
    const struct vector start = lane_vector(
        dem->pairs.group[pair / PAIRS_IN_GROUP].separation, pair % PAIRS_IN_GROUP);
    const double cutoff = (1 + MARGIN) * touching_distance(&dem->pairs, pair);
    return (struct distant_pair){
        .separation = {start.x, start.y, start.z,
                       dem->place[end[0]].radius - dem->place[end[1]].radius},
        .cutoff_square = cutoff * cutoff,
        .particle = {end[0], end[1]}};
}

// The next sweep would clear the shear force of a pair that is apart.
static void forget_shear(struct pair_list *pairs, int pair)
{
    for (int axis = 0; axis < 3; axis++)
        pairs->shear[pair / PAIRS_IN_GROUP].force[axis][pair % PAIRS_IN_GROUP] = 0;
}

// Lists the pairs that are further apart than the least gap, and the indices of those
// that stay active; returns how many stay.
static int split_pairs(struct dem *dem, struct inactive_pairs *inactive)
{
    int n = 0;
    for (int p = 0; p < dem->pairs.n_pair; p++) {
        const int32_t *end = dem->pairs.particle[p];
        if (are_fixed(dem, end)) continue;
        if (!is_bonded(dem, p)) {
            const struct distant_pair distant = distant_pair_of(dem, p);
            const double least = (1 + 2 * MARGIN) * touching_distance(&dem->pairs, p) +
                                 dem->min_inactive_gap;
            if (distance_square(dem->place, &distant) > least * least) {
                inactive->distant[inactive->n_distant++] = distant;
                inactive->largest_cutoff =
                    fmax(inactive->largest_cutoff, sqrt(distant.cutoff_square));
                forget_shear(&dem->pairs, p);
                continue;
            }
        }
        inactive->index[n++] = p;
    }
    return n;
}

// Copies ROWS numbers of one lane.
static void copy_rows(void *to, int to_pair, const void *from, int from_pair,
                      size_t group, size_t offset, int rows)
{
    const size_t there = (size_t)to_pair / PAIRS_IN_GROUP * group + offset;
    const size_t here = (size_t)from_pair / PAIRS_IN_GROUP * group + offset;
    double *a = (double *)((char *)to + there) + to_pair % PAIRS_IN_GROUP;
    const double *b =
        (const double *)((const char *)from + here) + from_pair % PAIRS_IN_GROUP;
    for (size_t k = 0; k < (size_t)rows; k++)
        a[k * PAIRS_IN_GROUP] = b[k * PAIRS_IN_GROUP];
}

#define COPY(groups, type, member, rows)                                               \
    copy_rows(to->groups, to_pair, from->groups, from_pair, sizeof(type),              \
              offsetof(type, member), rows)

// Copies what sweeps change.
static void copy_history(struct pair_list *to, int to_pair,
                         const struct pair_list *from, int from_pair)
{
    COPY(shear, struct shear_group, force, 3);
    COPY(bonds, struct bond_group, radius, 3);
    COPY(bonds, struct bond_group, shear_force, 8);
}

static void copy_pair(struct pair_list *to, int to_pair, const struct pair_list *from,
                      int from_pair)
{
    for (int end = 0; end < 2; end++)
        to->particle[to_pair][end] = from->particle[from_pair][end];
    to->bond[to_pair] = from->bond[from_pair];
    COPY(group, struct pair_group, separation, 6);
    if (to->laws) COPY(laws, struct law_group, normal_stiffness, 5);
    copy_history(to, to_pair, from, from_pair);
}

static void sweep_only(struct dem *dem, const struct inactive_pairs *inactive, int n)
{
    new_pairs(dem, n, allocate((size_t)n, 2 * sizeof(int32_t)), NEW_ARRAY(int32_t, n));
    struct pair_list *pairs = &dem->pairs;
    for (int p = 0; p < n; p++) {
        copy_pair(pairs, p, &inactive->all, inactive->index[p]);
        struct pair_group *group = &pairs->group[p / PAIRS_IN_GROUP];
        set_grains(group, p % PAIRS_IN_GROUP, pairs->particle[p][0],
                   pairs->particle[p][1]);
        pairs->bonds[p / PAIRS_IN_GROUP].crack[p % PAIRS_IN_GROUP] = -1;
    }
    for (int p = n; p < PAIRS_IN_GROUP * pairs->n_group; p++)
        set_dummy_pair(dem, p);
    arrange_sums(dem);
}

static void free_inactive(struct inactive_pairs *inactive)
{
    free(inactive->index);
    free(inactive->distant);
    free(inactive);
}

static void deactivate_pairs(struct dem *dem)
{
    enum { WORTH_IT = 16 }; // one in so many
    const int n = dem->pairs.n_pair;
    struct inactive_pairs *inactive = NEW_ARRAY(struct inactive_pairs, 1);
    inactive->index = NEW_ARRAY(int32_t, n);
    inactive->distant = allocate_aligned((size_t)n, sizeof *inactive->distant);
    const int n_swept = split_pairs(dem, inactive);
    if (n - n_swept < n / WORTH_IT) {
        free_inactive(inactive);
        return;
    }
    inactive->all = dem->pairs;
    dem->inactive = inactive;
    sweep_only(dem, inactive, n_swept);
}

void reactivate_pairs(struct dem *dem)
{
    struct inactive_pairs *inactive = dem->inactive;
    if (!inactive) return;
    for (int p = 0; p < dem->pairs.n_pair; p++)
        copy_history(&inactive->all, inactive->index[p], &dem->pairs, p);
    give_back_pairs(dem, &dem->pairs);
    dem->pairs = inactive->all;
    dem->inactive = NULL;
    free_inactive(inactive);
    arrange_sums(dem);
}

// The slack of the nearest pair, where LEAST is the smallest d^2 - c^2 (head of this
// file).
static double slack_of(const struct inactive_pairs *inactive, double least)
{
    const double cutoff = inactive->largest_cutoff;
    return least / (sqrt(cutoff * cutoff + least) + cutoff);
}

static bool any_may_touch(const struct dem *dem)
{
    struct inactive_pairs *inactive = dem->inactive;
    inactive->slack -= 2 * dem->last_travel;
    if (inactive->slack > 0) return false;
    double least = INFINITY;
    for (int k = 0; k < inactive->n_distant; k++) {
        const struct distant_pair *distant = &inactive->distant[k];
        const double beyond =
            distance_square(dem->place, distant) - distant->cutoff_square;
        least = beyond < least ? beyond : least;
    }
    if (!(least > 0)) return true;
    inactive->slack = slack_of(inactive, least);
    return false;
}

// Only after every pair has been swept once: in that sweep a bond without strength
// breaks, between fixed grains too. Not with a ledger, which books losses by pair, nor
// with liquid, as bridges reach over gaps.
static bool may_deactivate(const struct dem *dem)
{
    return dem->features & FEATURE_PARALLEL_BOND && !dem->liquid && !dem->pairs.loss &&
           dem->cycle > 0;
}

void update_inactive_pairs(struct dem *dem, int64_t left, bool begins)
{
    enum { LEAST_CYCLES = 64 }; // fewer do not pay for another list
    const bool disturbed = dem->inactive && any_may_touch(dem);
    if (disturbed || left == 1) reactivate_pairs(dem);
    // Taking pairs back costs a few cycles: it should happen about once in two hundred.
    if (disturbed) dem->min_inactive_gap = fmin(1.5 * dem->min_inactive_gap, 1e-2);
    if (begins) dem->min_inactive_gap = fmax(0.5 * dem->min_inactive_gap, 1e-7);
    if ((begins || disturbed) && left >= LEAST_CYCLES && may_deactivate(dem))
        deactivate_pairs(dem);
}
