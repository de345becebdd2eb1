// SPDX-License-Identifier: GPL-3.0-or-later
// Which thread finishes which grain, and where what its pairs do to it is added up
// [engine.h].
#include "dem/engine.h"

#include "basics/memory.h"

#include <stdlib.h>

// Which groups have to do with each grain; it may move after the last.
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

void arrange_sums(struct dem *dem)
{
    assign_groups(dem);
    assign_sums(dem);
}
