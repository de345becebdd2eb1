// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of near spheres of any range of sizes: spheres are sorted into levels of size,
// a grid for each, with cells at least as wide as two of its largest reaches; every
// sphere looks in the grids of its own and larger levels, in neighbouring cells only,
// and in its own level at later members only. O(n) for each level. Spheres are taken in
// the order of the cells, whatever their own order, and pairs are sorted at the end.
//     level = floor(log2(largest / reach)), 15 at most; width = 2 largest / 2^level;
//     near: |x_j - x_i|, by the nearest image, <= reach_i + reach_j.
// Threads take spheres by shares of fixed size, and each share keeps its own list, so
// the order of pairs does not depend on their number.
#include "geometry/neighbours.h"

#include "basics/memory.h"
#include "geometry/linked_cells.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_LEVELS = 16 };

// The spheres of one level of sizes, in cells at least as wide as two of the largest
// reaches among them, so that whoever is no larger meets them in neighbouring cells.
struct grid {
    struct linked_cells cells;
    int members;
    double *at[3], *reach; // (members) in the order of the cells
};

struct pairs {
    int32_t (*pair)[2];
    int count, capacity;
};

static struct grid fill_grid(const struct spheres *all, const uint8_t *level, int which,
                             double width)
{
    struct grid grid = {0};
    int *chosen = NEW_ARRAY(int, all->count);
    for (int i = 0; i < all->count; i++)
        if (level[i] == which) chosen[grid.members++] = i;
    struct box_of_places box;
    memcpy(box.lower, all->lower, sizeof box.lower);
    memcpy(box.period, all->period, sizeof box.period);
    grid.cells =
        linked_cells_init(&box, all->count, all->position, grid.members, chosen, width);
    free(chosen);
    grid.reach = NEW_ARRAY(double, grid.members);
    for (int k = 0; k < grid.members; k++)
        grid.reach[k] = all->reach[grid.cells.member[k]];
    for (int axis = 0; axis < 3; axis++) {
        grid.at[axis] = NEW_ARRAY(double, grid.members);
        for (int k = 0; k < grid.members; k++)
            grid.at[axis][k] = component(all->position[grid.cells.member[k]], axis);
    }
    return grid;
}

static void free_grid(struct grid *grid)
{
    linked_cells_free(&grid->cells);
    free(grid->reach);
    for (int axis = 0; axis < 3; axis++)
        free(grid->at[axis]);
}

// The cells around X along an axis, each once; how many.
static int cells_around(const struct linked_cells *cells, int axis, double x,
                        int around[3])
{
    const int count = cells->count[axis], cell = cell_along(cells, axis, x);
    int n = 0;
    for (int step = -1; step <= 1; step++) {
        if (cells->repeats[axis] && n < count)
            around[n++] = (cell + step + count) % count;
        else if (!cells->repeats[axis] && cell + step >= 0 && cell + step < count)
            around[n++] = cell + step;
    }
    return n;
}

// Members BEGIN..END-1 of a grid: those of cells side by side.
struct member_range {
    int begin, end;
};

// What is around a place, in at most one range for each cell; how many. Cells that
// follow each other along z follow each other in memory.
static int ranges_around(const struct linked_cells *cells, struct vector place,
                         struct member_range range[27])
{
    int around[3][3], n[3], ranges = 0;
    for (int axis = 0; axis < 3; axis++)
        n[axis] = cells_around(cells, axis, component(place, axis), around[axis]);
    for (int x = 0; x < n[0]; x++)
        for (int y = 0; y < n[1]; y++)
            for (int z = 0; z < n[2]; z++) {
                const int cell = cell_number(
                    cells, (int[]){around[0][x], around[1][y], around[2][z]});
                const int begin = cells->offset[cell], end = cells->offset[cell + 1];
                if (z > 0 && range[ranges - 1].end == begin)
                    range[ranges - 1].end = end;
                else
                    range[ranges++] = (struct member_range){begin, end};
            }
    return ranges;
}

// Members are looked at in chunks, so that vectors take several at once.
enum { CHUNK = 32 };

// Adds the squares of the distances along an axis, by the nearest image.
static void add_squares(const double *at, int n, double from, double period,
                        double square[CHUNK])
{
    if (!(period > 0)) {
        for (int k = 0; k < n; k++)
            square[k] += (at[k] - from) * (at[k] - from);
        return;
    }
    const double per_period = 1 / period;
    for (int k = 0; k < n; k++) {
        double along = at[k] - from;
        along -= period * rint(along * per_period);
        square[k] += along * along;
    }
}

// Those of N members from BEGIN on that are near sphere I; how many.
static int near_in_chunk(const struct spheres *all, const struct grid *grid, int begin,
                         int n, int i, int near[CHUNK])
{
    double square[CHUNK] = {0}, most[CHUNK];
    for (int axis = 0; axis < 3; axis++)
        add_squares(grid->at[axis] + begin, n, component(all->position[i], axis),
                    all->period[axis], square);
    for (int k = 0; k < n; k++) {
        const double both = all->reach[i] + grid->reach[begin + k];
        most[k] = both * both;
    }
    int count = 0;
    for (int k = 0; k < n; k++) {
        near[count] = begin + k;
        count += square[k] <= most[k];
    }
    return count;
}

static void add_pair(struct pairs *found, int i, int j)
{
    GROW_ARRAY(found->pair, found->count, found->capacity);
    found->pair[found->count][0] = i < j ? i : j;
    found->pair[found->count++][1] = i < j ? j : i;
}

// Adds the pairs of sphere I with members of GRID, of which it meets those from FIRST
// on.
static void meet_grid(const struct spheres *all, const struct grid *grid, int i,
                      int first, struct pairs *found)
{
    struct member_range range[27];
    const int n = ranges_around(&grid->cells, all->position[i], range);
    for (int r = 0; r < n; r++)
        for (int begin = range[r].begin > first ? range[r].begin : first;
             begin < range[r].end; begin += CHUNK) {
            const int left = range[r].end - begin;
            int near[CHUNK] = {0};
            const int count =
                near_in_chunk(all, grid, begin, left < CHUNK ? left : CHUNK, i, near);
            for (int k = 0; k < count; k++)
                add_pair(found, i, grid->cells.member[near[k]]);
        }
}

// Adds the pairs of member K of LEVEL: with all larger spheres, and with those of its
// own level that come later in the order of the cells.
static void meet_all(const struct spheres *all, const struct grid *grid, int level,
                     int k, struct pairs *found)
{
    const int i = grid[level].cells.member[k];
    meet_grid(all, &grid[level], i, k + 1, found);
    for (int l = 0; l < level; l++)
        meet_grid(all, &grid[l], i, 0, found);
}

int compare_pairs(const void *a, const void *b)
{
    const int32_t *p = a, *q = b;
    const int first = (p[0] > q[0]) - (p[0] < q[0]);
    return first ? first : (p[1] > q[1]) - (p[1] < q[1]);
}

// The second grains of one first grain: few, and nearly in order.
static void sort_seconds(int32_t (*pair)[2], int count)
{
    for (int k = 1; k < count; k++) {
        const int32_t second = pair[k][1];
        int to = k;
        for (; to > 0 && pair[to - 1][1] > second; to--)
            pair[to][1] = pair[to - 1][1];
        pair[to][1] = second;
    }
}

// The pairs of all PARTS in order, which end them.
static int32_t (*merge(struct pairs *part, int parts, int n, int *count))[2]
{
    int *offset = NEW_ARRAY(int, n + 2);
    for (int t = 0; t < parts; t++)
        for (int k = 0; k < part[t].count; k++)
            offset[part[t].pair[k][0] + 2]++;
    for (int i = 0; i < n; i++)
        offset[i + 2] += offset[i + 1];
    *count = offset[n + 1];
    int32_t(*all)[2] = allocate((size_t)*count, sizeof *all);
    for (int t = 0; t < parts; t++) {
        for (int k = 0; k < part[t].count; k++)
            memcpy(all[offset[part[t].pair[k][0] + 1]++], part[t].pair[k], sizeof *all);
        free(part[t].pair);
    }
    enum { FEW = 32 };
    for (int i = 0; i < n; i++) {
        const int begin = offset[i], size = offset[i + 1] - begin;
        if (size <= FEW)
            sort_seconds(all + begin, size);
        else
            qsort(all + begin, (size_t)size, sizeof *all, compare_pairs);
    }
    free(offset);
    return all;
}

// By how often the largest reach can be halved before it is below one's own.
static uint8_t *find_levels(const struct spheres *all, int *levels, double *largest)
{
    uint8_t *level = NEW_ARRAY(uint8_t, all->count);
    *largest = 0;
    for (int i = 0; i < all->count; i++)
        *largest = fmax(*largest, all->reach[i]);
    *levels = 1;
    for (int i = 0; i < all->count; i++) {
        const int halvings = ilogb(*largest / all->reach[i]);
        level[i] = (uint8_t)(halvings < MOST_LEVELS ? halvings : MOST_LEVELS - 1);
        if (level[i] >= *levels) *levels = level[i] + 1;
    }
    return level;
}

// What a thread takes at a time.
struct share {
    int level, begin, end; // members
};

static struct share *shares_of(const struct grid *grid, int levels, int *count)
{
    enum { SIZE = 4096 };
    *count = 0;
    for (int l = 0; l < levels; l++)
        *count += (grid[l].members + SIZE - 1) / SIZE;
    struct share *share = NEW_ARRAY(struct share, *count);
    for (int l = 0, n = 0; l < levels; l++)
        for (int begin = 0; begin < grid[l].members; begin += SIZE) {
            const int left = grid[l].members - begin;
            share[n++] = (struct share){l, begin, begin + (left < SIZE ? left : SIZE)};
        }
    return share;
}

int32_t (*near_pairs(const struct spheres *all, int *count))[2]
{
    int levels;
    double largest;
    uint8_t *level = find_levels(all, &levels, &largest);
    struct grid grid[MOST_LEVELS];
    for (int l = 0; l < levels; l++)
        grid[l] = fill_grid(all, level, l, ldexp(2 * largest, -l));

    int parts;
    struct share *share = shares_of(grid, levels, &parts);
    struct pairs *part = NEW_ARRAY(struct pairs, parts);
#pragma omp parallel for num_threads(all->threads) schedule(dynamic, 1)
    for (int t = 0; t < parts; t++)
        for (int k = share[t].begin; k < share[t].end; k++)
            meet_all(all, grid, share[t].level, k, &part[t]);

    for (int l = 0; l < levels; l++)
        free_grid(&grid[l]);
    free(level);
    free(share);
    int32_t(*pair)[2] = merge(part, parts, all->count, count);
    free(part);
    return pair;
}

int32_t (*reaching_pairs(const struct packing *packing, const double *reach,
                         int *count))[2]
{
    struct spheres all = {.count = packing->n_particle,
                          .position = packing->position,
                          .reach = reach,
                          .threads = 1};
    for (int axis = 0; axis < 3; axis++) {
        all.lower[axis] = component(packing->lower, axis);
        if (packing->periodic[axis])
            all.period[axis] = component(packing->upper, axis) - all.lower[axis];
    }
    return near_pairs(&all, count);
}

int32_t (*neighbour_pairs(const struct packing *packing, double gap, int *count))[2]
{
    double *reach = NEW_ARRAY(double, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++)
        reach[i] = (1 + gap) * packing->radius[i];
    int32_t(*pair)[2] = reaching_pairs(packing, reach, count);
    free(reach);
    return pair;
}
