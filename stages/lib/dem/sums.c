// SPDX-License-Identifier: GPL-3.0-or-later
// Which thread finishes which grain, and where the loads of its pairs are added up
// [engine.h]. In code order, with pairs sorted by their first grain,
//     first_group  the first group that has a pair of the grain
//     last_group   the last with a pair whose first grain is it or one before; after
//                  that group the grain may move
//     shared       where these two lie in chunks of different threads
//     rows         one for each grain and the dummy, then one for each pair of a shared
//                  grain, in the order of pairs
// Each pair of a shared grain adds to a row of its own, and the rows are summed later
// in the order of pairs. So the order of each sum does not depend on the number of
// threads.
#include "dem/engine.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

// First and last group with a pair of each grain; the grain may move after the last.
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

// Shared are grains with pairs in the groups of another chunk than the one that
// finishes them.
static void find_shared_grains(struct dem *dem)
{
    const int share = groups_in_chunk(dem);
    dem->n_shared = 0;
    for (int i = 0; i < dem->n_particle; i++) {
        dem->is_shared[i] = dem->last_group[i] >= 0 &&
                            dem->first_group[i] / share < dem->last_group[i] / share;
        if (dem->is_shared[i]) dem->shared_grain[dem->n_shared++] = i;
    }
}

// Gives shared grains a row for each of their pairs, behind the rows of all grains;
// returns the number of rows.
static int number_rows_of_shared(struct dem *dem)
{
    int row = dem->n_particle + 1;
    for (int k = 0; k < dem->n_shared; k++) {
        const int i = dem->shared_grain[k];
        dem->first_row[k] = row;
        row += dem->pair_offset[i + 1] - dem->pair_offset[i];
    }
    dem->first_row[dem->n_shared] = row;
    return row;
}

static void assign_rows(struct dem *dem)
{
    int32_t *row = NEW_ARRAY(int32_t, dem->n_particle + 1);
    for (int i = 0; i <= dem->n_particle; i++)
        row[i] = i;
    for (int k = 0; k < dem->n_shared; k++)
        row[dem->shared_grain[k]] = dem->first_row[k];
    for (int k = 0; k < dem->pairs.n_group; k++)
        for (int at = 0; at < PAIRS_IN_GROUP; at++)
            for (int end = 0; end < 2; end++) {
                const struct pair_group *group = &dem->pairs.group[k];
                struct sum_group *sum = &dem->pairs.sum[k];
                const int i = end ? second_grain(group, at) : first_grain(group, at);
                (end ? sum->second : sum->first)[at] = INDEX_SCALE * (uint32_t)row[i];
                if (row[i] == i) continue;
                dem->pairs.has_shared_grain[k] = true;
                row[i]++;
            }
    free(row);
}

static void assign_sums(struct dem *dem)
{
    const bool is_large = dem->pairs.n_pair > MIN_PARALLEL_PAIRS;
    dem->n_chunk = is_large ? dem->threads : 1;
    find_shared_grains(dem);
    const size_t rows = (size_t)number_rows_of_shared(dem);
    const size_t room = rows * (dem->features & FEATURE_ROTATION ? 8 : 4);
    memset(dem->pairs.has_shared_grain, 0, (size_t)dem->pairs.n_group);
    if (dem->n_shared > 0) assign_rows(dem);
    if (room <= dem->sum_room) return; // it is 0 between cycles
    free(dem->sum);
    dem->sum_room = room + room / 8;
    dem->sum = allocate_aligned(dem->sum_room, sizeof *dem->sum);
}

void arrange_sums(struct dem *dem)
{
    assign_groups(dem);
    assign_sums(dem);
}
