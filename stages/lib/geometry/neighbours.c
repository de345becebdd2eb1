// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of near spheres of any range of sizes: spheres are sorted into levels of size,
// a grid for each, with cells at least as wide as two of its largest reaches; every
// sphere looks in the grids of its own and larger levels, in neighbouring cells only.
// O(n) for each level. Pairs come sorted.
//     level = floor(log2(largest / reach)), 15 at most; width = 2 largest / 2^level;
//     near: |x_j - x_i|, by the nearest image, <= reach_i + reach_j.
// Threads take spheres by shares of fixed size, and each share keeps its own list, so
// the order of pairs does not depend on their number.
#include "geometry/neighbours.h"

#include "basics/memory.h"
#include "basics/simd.h"
#include "geometry/linked_cells.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_LEVELS = 16 };

struct member {
    struct vector position;
    double reach;
    int32_t index;
};

// The spheres of one level of sizes, in cells at least as wide as two of the largest
// reaches among them, so that whoever is no larger meets them in neighbouring cells.
struct grid {
    struct linked_cells cells;
    struct member *member; // in the order of the cells, side by side in memory
};

struct pairs {
    int32_t (*pair)[2];
    int count, capacity;
};

static struct grid fill_grid(const struct spheres *all, const uint8_t *level, int which,
                             double width)
{
    int members = 0;
    int *chosen = NEW_ARRAY(int, all->count);
    for (int i = 0; i < all->count; i++)
        if (level[i] == which) chosen[members++] = i;
    struct box_of_places box;
    memcpy(box.lower, all->lower, sizeof box.lower);
    memcpy(box.period, all->period, sizeof box.period);
    struct grid grid = {
        linked_cells_init(&box, all->count, all->position, members, chosen, width),
        NEW_ARRAY(struct member, members)};
    for (int k = 0; k < members; k++) {
        const int i = grid.cells.member[k];
        grid.member[k] = (struct member){all->position[i], all->reach[i], i};
    }
    free(chosen);
    return grid;
}

static void free_grid(struct grid *grid)
{
    linked_cells_free(&grid->cells);
    free(grid->member);
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

SIMD_INLINE double apart_square(const struct spheres *all, struct vector apart,
                                bool repeats)
{
    if (!repeats) return dot(apart, apart);
    double square = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double period = all->period[axis];
        double along = component(apart, axis);
        if (period > 0) along -= period * rint(along / period);
        square += along * along;
    }
    return square;
}

// Adds the pairs of sphere I with members of GRID in RANGE; of its own level only the
// later ones. REPEATS: the box does.
SIMD_INLINE void meet_range(const struct spheres *all, const struct grid *grid,
                            struct member_range range, int i, bool own_level,
                            bool repeats, struct pairs *found)
{
    const struct vector from = all->position[i];
    const double reach = all->reach[i];
    for (int m = range.begin; m < range.end; m++) {
        const struct member *member = &grid->member[m];
        const double both = reach + member->reach;
        const double square =
            apart_square(all, subtract(member->position, from), repeats);
        const int j = member->index;
        if (!(square <= both * both) || (own_level && j <= i)) continue;
        GROW_ARRAY(found->pair, found->count, found->capacity);
        found->pair[found->count][0] = i < j ? i : j;
        found->pair[found->count++][1] = i < j ? j : i;
    }
}

static void meet_grid(const struct spheres *all, const struct grid *grid, int i,
                      bool own_level, struct pairs *found)
{
    const double *period = all->period;
    const bool repeats = period[0] > 0 || period[1] > 0 || period[2] > 0;
    struct member_range range[27];
    const int n = ranges_around(&grid->cells, all->position[i], range);
    for (int k = 0; k < n; k++)
        if (repeats)
            meet_range(all, grid, range[k], i, own_level, true, found);
        else
            meet_range(all, grid, range[k], i, own_level, false, found);
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

int32_t (*near_pairs(const struct spheres *all, int *count))[2]
{
    int levels;
    double largest;
    uint8_t *level = find_levels(all, &levels, &largest);
    struct grid grid[MOST_LEVELS];
    for (int l = 0; l < levels; l++)
        grid[l] = fill_grid(all, level, l, ldexp(2 * largest, -l));

    enum { SHARE = 4096 };
    const int parts = (all->count + SHARE - 1) / SHARE;
    struct pairs *part = NEW_ARRAY(struct pairs, parts);
#pragma omp parallel for num_threads(all->threads) schedule(dynamic, 1)
    for (int t = 0; t < parts; t++)
        for (int i = t * SHARE; i < (t + 1) * SHARE && i < all->count; i++)
            for (int l = level[i]; l >= 0; l--)
                meet_grid(all, &grid[l], i, l == level[i], &part[t]);

    for (int l = 0; l < levels; l++)
        free_grid(&grid[l]);
    free(level);
    int32_t(*pair)[2] = merge(part, parts, all->count, count);
    free(part);
    return pair;
}

int32_t (*neighbour_pairs(const struct packing *packing, double gap, int *count))[2]
{
    double *reach = NEW_ARRAY(double, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++)
        reach[i] = (1 + gap) * packing->radius[i];
    struct spheres all = {.count = packing->n_particle,
                          .position = packing->position,
                          .reach = reach,
                          .threads = 1};
    for (int axis = 0; axis < 3; axis++) {
        all.lower[axis] = component(packing->lower, axis);
        if (packing->periodic[axis])
            all.period[axis] = component(packing->upper, axis) - all.lower[axis];
    }
    int32_t(*pair)[2] = near_pairs(&all, count);
    free(reach);
    return pair;
}

struct vector nearest_image(const struct packing *packing, int i, int j)
{
    struct vector apart = subtract(packing->position[j], packing->position[i]);
    for (int axis = 0; axis < 3; axis++) {
        if (!packing->periodic[axis]) continue;
        const double edge =
            component(packing->upper, axis) - component(packing->lower, axis);
        const double along = component(apart, axis);
        set_component(&apart, axis, along - edge * round(along / edge));
    }
    return apart;
}
