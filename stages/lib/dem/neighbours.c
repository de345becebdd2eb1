// SPDX-License-Identifier: GPL-3.0-or-later
// Which pairs are near enough to touch before the next search: linked cells with a
// skin. Bonded pairs stay whatever their distance.
#include "dem/engine.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct candidate {
    int32_t particle[2];
    int32_t bond;
};

struct candidates {
    int count, capacity;
    struct candidate *list;
};

static void append(struct candidates *found, struct candidate candidate)
{
    GROW_ARRAY(found->list, found->count, found->capacity);
    found->list[found->count++] = candidate;
}

static struct vector position_now(const struct dem *dem, int particle)
{
    return add(dem->start[particle], as_vector(dem->place[particle].displacement));
}

// A, moved by whole periods to its shortest.
static struct vector shortest(const struct dem *dem, struct vector a)
{
    for (int axis = 0; axis < 3; axis++) {
        const double period = dem->period[axis];
        if (period <= 0) continue;
        const double length = component(a, axis);
        set_component(&a, axis, length - period * rint(length / period));
    }
    return a;
}

// Cells no smaller than the longest reach, so that partners lie in neighbouring ones.
struct grid {
    int count[3];
    double lower[3];
    double cells_per_length[3];
    bool repeats[3];
    int *offset; // (cells+1) into particle
    int *particle;
};

static int cell_along(const struct grid *grid, int axis, double x)
{
    double at = (x - grid->lower[axis]) * grid->cells_per_length[axis];
    if (grid->repeats[axis]) at -= grid->count[axis] * floor(at / grid->count[axis]);
    const int cell = (int)at;
    return cell < 0 ? 0 : cell >= grid->count[axis] ? grid->count[axis] - 1 : cell;
}

static int cell_of(const struct grid *grid, struct vector position)
{
    const int x = cell_along(grid, 0, position.x), y = cell_along(grid, 1, position.y);
    const int z = cell_along(grid, 2, position.z);
    return (x * grid->count[1] + y) * grid->count[2] + z;
}

// The box of the grains, or of the period; not many more cells than grains.
static void size_grid(struct grid *grid, const struct dem *dem, double reach)
{
    const double most = ceil(2 * cbrt(dem->n_particle)) + 1;
    for (int axis = 0; axis < 3; axis++) {
        double lower = INFINITY, upper = -INFINITY;
        for (int i = 0; i < dem->n_particle; i++) {
            const double x = component(position_now(dem, i), axis);
            lower = fmin(lower, x);
            upper = fmax(upper, x);
        }
        grid->repeats[axis] = dem->period[axis] > 0;
        if (grid->repeats[axis]) {
            lower = dem->box_lower[axis];
            upper = lower + dem->period[axis];
        }
        const double length = fmax(upper - lower, reach);
        grid->count[axis] = (int)fmin(floor(length / reach), most);
        grid->lower[axis] = lower;
        grid->cells_per_length[axis] = grid->count[axis] / length;
    }
}

static struct grid sort_into_cells(const struct dem *dem, double reach)
{
    struct grid grid = {0};
    size_grid(&grid, dem, reach);
    const int n_cell = grid.count[0] * grid.count[1] * grid.count[2];
    grid.offset = NEW_ARRAY(int, n_cell + 2);
    grid.particle = NEW_ARRAY(int, dem->n_particle);
    int *cell = NEW_ARRAY(int, dem->n_particle);
    for (int i = 0; i < dem->n_particle; i++) {
        cell[i] = cell_of(&grid, position_now(dem, i));
        grid.offset[cell[i] + 2]++;
    }
    for (int c = 0; c < n_cell; c++)
        grid.offset[c + 2] += grid.offset[c + 1];
    // Filling moves each offset one on, so that cell c ends where c + 1 begins.
    for (int i = 0; i < dem->n_particle; i++)
        grid.particle[grid.offset[cell[i] + 1]++] = i;
    free(cell);
    return grid;
}

// The cells around CELL along an axis, each once; how many.
static int cells_around(const struct grid *grid, int axis, int cell, int around[3])
{
    const int count = grid->count[axis];
    int n = 0;
    for (int step = -1; step <= 1; step++) {
        if (grid->repeats[axis] && n < count)
            around[n++] = (cell + step + count) % count;
        else if (!grid->repeats[axis] && cell + step >= 0 && cell + step < count)
            around[n++] = cell + step;
    }
    return n;
}

static bool is_near(const struct dem *dem, int i, int j)
{
    const struct vector apart =
        shortest(dem, subtract(position_now(dem, j), position_now(dem, i)));
    const double reach = dem->place[i].radius + dem->place[j].radius + SEARCH_SKIN;
    return dot(apart, apart) <= reach * reach;
}

static void search_around(const struct dem *dem, const struct grid *grid, int i,
                          struct candidates *found)
{
    const struct vector position = position_now(dem, i);
    int around[3][3], n[3];
    for (int axis = 0; axis < 3; axis++)
        n[axis] =
            cells_around(grid, axis, cell_along(grid, axis, component(position, axis)),
                         around[axis]);
    for (int x = 0; x < n[0]; x++)
        for (int y = 0; y < n[1]; y++)
            for (int z = 0; z < n[2]; z++) {
                const int cell =
                    (around[0][x] * grid->count[1] + around[1][y]) * grid->count[2] +
                    around[2][z];
                for (int k = grid->offset[cell]; k < grid->offset[cell + 1]; k++) {
                    const int j = grid->particle[k];
                    if (j > i && is_near(dem, i, j))
                        append(found, (struct candidate){{i, j}, -1});
                }
            }
}

static int by_particles(const void *a, const void *b)
{
    const struct candidate *p = a, *q = b;
    for (int k = 0; k < 2; k++)
        if (p->particle[k] != q->particle[k])
            return p->particle[k] < q->particle[k] ? -1 : 1;
    return (p->bond < q->bond) - (p->bond > q->bond); // a bond first
}

// Near pairs and bonded pairs, each once, sorted.
static struct candidates seek(const struct dem *dem)
{
    struct candidates found = {0};
    for (int b = 0; b < dem->n_bond; b++)
        append(&found, (struct candidate){
                           {dem->bond_particle[b][0], dem->bond_particle[b][1]}, b});
    struct grid grid = sort_into_cells(dem, 2 * dem->largest_radius + SEARCH_SKIN);
    for (int i = 0; i < dem->n_particle; i++)
        search_around(dem, &grid, i, &found);
    free(grid.offset);
    free(grid.particle);
    if (found.count == 0) return found;

    qsort(found.list, (size_t)found.count, sizeof *found.list, by_particles);
    int kept = 1;
    for (int k = 1; k < found.count; k++)
        if (memcmp(found.list[k].particle, found.list[kept - 1].particle,
                   sizeof found.list[k].particle) != 0)
            found.list[kept++] = found.list[k];
    found.count = kept;
    return found;
}

struct lane {
    struct pair_group *group;
    int at;
};

static struct lane lane_of(const struct pair_list *pairs, int pair)
{
    return (struct lane){&pairs->group[pair / PAIRS_IN_GROUP], pair % PAIRS_IN_GROUP};
}

// Pairs that touch as given come with an overlap of the rounding of their coordinates;
// it counts as none.
static double given_overlap(const struct dem *dem, double sum_of_radii, double distance)
{
    const double overlap = sum_of_radii - distance;
    return fabs(overlap) <= dem->coordinate_error ? 0 : overlap;
}

static void set_pair(struct dem *dem, int pair, struct candidate candidate)
{
    const struct lane to = lane_of(&dem->pairs, pair);
    const int i = candidate.particle[0], j = candidate.particle[1];
    const struct vector now = subtract(position_now(dem, j), position_now(dem, i));
    const struct vector periods = subtract(shortest(dem, now), now);
    const struct vector separation =
        add(subtract(dem->start[j], dem->start[i]), periods);
    for (int axis = 0; axis < 3; axis++)
        to.group->separation[axis][to.at] = component(separation, axis);
    const double distance = norm(separation);
    to.group->distance[to.at] = distance;
    to.group->overlap[to.at] =
        given_overlap(dem, dem->place[i].radius + dem->place[j].radius, distance);
    to.group->root_mass[to.at] =
        sqrt(dem->mass[i] * dem->mass[j] / (dem->mass[i] + dem->mass[j]));
    to.group->normal_strength[to.at] = -1;
    to.group->shear_strength[to.at] = -1;
    const int b = candidate.bond;
    if (b < 0) return;
    to.group->bond_radius[to.at] = dem->bond_radius[b];
    to.group->normal_strength[to.at] = dem->bond_strength[DEM_CRACK_NORMAL][b];
    to.group->shear_strength[to.at] = dem->bond_strength[DEM_CRACK_SHEAR][b];
}

// A lane that holds no pair.
static void set_nobody(struct dem *dem, int pair)
{
    const struct lane to = lane_of(&dem->pairs, pair);
    to.group->first[to.at] = to.group->second[to.at] = dem->n_particle;
    to.group->separation[0][to.at] = 1;
    to.group->distance[to.at] = 1;
    to.group->overlap[to.at] = -1;
    to.group->normal_strength[to.at] = -1;
    to.group->shear_strength[to.at] = -1;
}

// History and image of a pair that was there before.
static void carry_over(struct lane to, struct lane from)
{
    for (int axis = 0; axis < 3; axis++) {
        to.group->separation[axis][to.at] = from.group->separation[axis][from.at];
        to.group->shear_force[axis][to.at] = from.group->shear_force[axis][from.at];
        to.group->bond_shear_force[axis][to.at] =
            from.group->bond_shear_force[axis][from.at];
        to.group->bond_bending[axis][to.at] = from.group->bond_bending[axis][from.at];
    }
    to.group->distance[to.at] = from.group->distance[from.at];
    to.group->overlap[to.at] = from.group->overlap[from.at];
    to.group->bond_twist[to.at] = from.group->bond_twist[from.at];
}

static void fill_pairs(struct dem *dem, const struct candidates *found,
                       const struct pair_list *old)
{
    for (int k = 0; k < dem->pairs.n_group; k++)
        memset(dem->pairs.group[k].crack, -1, sizeof dem->pairs.group[k].crack);
    int before = 0;
    for (int p = 0; p < found->count; p++) {
        const struct candidate candidate = found->list[p];
        memcpy(dem->pairs.particle[p], candidate.particle, sizeof candidate.particle);
        dem->pairs.bond[p] = candidate.bond;
        const struct lane to = lane_of(&dem->pairs, p);
        to.group->first[to.at] = candidate.particle[0];
        to.group->second[to.at] = candidate.particle[1];
        set_pair(dem, p, candidate);

        struct candidate last = {{0, 0}, candidate.bond};
        int order = -1;
        while (before < old->n_pair && order < 0) {
            memcpy(last.particle, old->particle[before], sizeof last.particle);
            order = by_particles(&last, &candidate);
            if (order < 0) before++;
        }
        if (before < old->n_pair && order == 0) carry_over(to, lane_of(old, before));
    }
    for (int p = found->count; p < PAIRS_IN_GROUP * dem->pairs.n_group; p++)
        set_nobody(dem, p);
}

// Gap to a wall, along its normal, where the grain began.
static double wall_overlap(const struct dem *dem, const struct dem_wall *wall, int i)
{
    const double height = dot(subtract(dem->start[i], wall->point), wall->normal);
    return given_overlap(dem, dem->place[i].radius, height);
}

static void find_wall_pairs(struct dem *dem)
{
    struct wall_pair *old = dem->wall_pair;
    const int n_old = dem->n_wall_pair;
    int capacity = 0, before = 0;
    dem->wall_pair = NULL;
    dem->n_wall_pair = 0;
    for (int i = 0; i < dem->n_particle; i++)
        for (int w = 0; w < dem->n_wall; w++) {
            const double overlap = wall_overlap(dem, &dem->wall[w], i);
            const double rise =
                dot(as_vector(dem->place[i].displacement), dem->wall[w].normal);
            if (overlap - rise < -SEARCH_SKIN) continue;
            struct wall_pair pair = {.particle = i,
                                     .wall = w,
                                     .overlap = overlap,
                                     .root_mass = sqrt(dem->mass[i])};
            while (before < n_old &&
                   (old[before].particle < i ||
                    (old[before].particle == i && old[before].wall < w)))
                before++;
            if (before < n_old && old[before].particle == i && old[before].wall == w)
                pair.shear_force = old[before].shear_force;
            GROW_ARRAY(dem->wall_pair, dem->n_wall_pair, capacity);
            dem->wall_pair[dem->n_wall_pair++] = pair;
        }
    free(old);
}

// Every grain's slots side by side: pairs in their order, then walls.
static void assign_slots(struct dem *dem)
{
    const int n = dem->n_particle;
    memset(dem->slot_offset, 0, ((size_t)n + 1) * sizeof *dem->slot_offset);
    for (int p = 0; p < dem->pairs.n_pair; p++)
        for (int end = 0; end < 2; end++)
            dem->slot_offset[dem->pairs.particle[p][end] + 1]++;
    for (int k = 0; k < dem->n_wall_pair; k++)
        dem->slot_offset[dem->wall_pair[k].particle + 1]++;
    for (int i = 0; i < n; i++)
        dem->slot_offset[i + 1] += dem->slot_offset[i];

    int *next = duplicate(dem->slot_offset, (size_t)n + 1, sizeof *next);
    for (int p = 0; p < PAIRS_IN_GROUP * dem->pairs.n_group; p++) {
        const struct lane to = lane_of(&dem->pairs, p);
        const bool real = p < dem->pairs.n_pair;
        to.group->first_slot[to.at] = real ? next[to.group->first[to.at]]++ : next[n];
        to.group->second_slot[to.at] =
            real ? next[to.group->second[to.at]]++ : next[n] + 1;
    }
    for (int k = 0; k < dem->n_wall_pair; k++)
        dem->wall_pair[k].slot = next[dem->wall_pair[k].particle]++;
    free(dem->slot);
    dem->slot = allocate_aligned((size_t)dem->slot_offset[n] + 2, sizeof *dem->slot);
    free(next);
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

void find_pairs(struct dem *dem)
{
    const struct pair_list old = dem->pairs;
    struct candidates found = seek(dem);
    const int n_group = (found.count + PAIRS_IN_GROUP - 1) / PAIRS_IN_GROUP;
    dem->pairs = (struct pair_list){
        .n_pair = found.count,
        .particle = allocate((size_t)found.count, sizeof *old.particle),
        .bond = NEW_ARRAY(int32_t, found.count),
        .n_group = n_group,
        .group = allocate_aligned((size_t)n_group, sizeof *old.group)};
    fill_pairs(dem, &found, &old);
    free(found.list);
    free(old.particle);
    free(old.bond);
    free(old.group);
    find_wall_pairs(dem);
    assign_slots(dem);
    assign_groups(dem);
    for (int i = 0; i < dem->n_particle; i++)
        dem->place_at_search[i] = as_vector(dem->place[i].displacement);
    dem->travelled = 0;
}

void keep_pairs(struct dem *dem)
{
    if (dem->travelled <= 0.5 * SEARCH_SKIN) return;
    double furthest = 0;
    for (int i = 0; i < dem->n_particle; i++)
        furthest = fmax(furthest, distance(as_vector(dem->place[i].displacement),
                                           dem->place_at_search[i]));
    dem->travelled = furthest;
    // So near the limit that looking again soon would cost more than a search.
    if (furthest > 0.9 * 0.5 * SEARCH_SKIN) find_pairs(dem);
}
