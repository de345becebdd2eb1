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

static bool is_near(const struct spheres *all, const struct member *m,
                    struct vector from, double reach)
{
    double square = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double period = all->period[axis];
        double apart = component(m->position, axis) - component(from, axis);
        if (period > 0) apart -= period * rint(apart / period);
        square += apart * apart;
    }
    return square <= (reach + m->reach) * (reach + m->reach);
}

// Pairs of sphere I with those of GRID; of its own level only the later ones.
static void meet_grid(const struct spheres *all, const struct grid *grid, int i,
                      bool own_level, struct pairs *found)
{
    const struct vector from = all->position[i];
    int around[3][3], n[3];
    for (int axis = 0; axis < 3; axis++)
        n[axis] = cells_around(&grid->cells, axis, component(from, axis), around[axis]);
    for (int k = 0; k < n[0] * n[1] * n[2]; k++) {
        const int cell = cell_number(&grid->cells, (int[]){around[0][k / (n[1] * n[2])],
                                                           around[1][k / n[2] % n[1]],
                                                           around[2][k % n[2]]});
        for (int m = grid->cells.offset[cell]; m < grid->cells.offset[cell + 1]; m++) {
            const int j = grid->member[m].index;
            if (own_level && j <= i) continue;
            if (!is_near(all, &grid->member[m], from, all->reach[i])) continue;
            GROW_ARRAY(found->pair, found->count, found->capacity);
            found->pair[found->count][0] = i < j ? i : j;
            found->pair[found->count++][1] = i < j ? j : i;
        }
    }
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
