// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/neighbours.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CELLS = 512 }; // along one axis: bounds the memory of sparse scenes

// The box of all grains in cells at least as wide as the farthest that two neighbours'
// centres can be apart.
struct cells {
    struct vector origin, width;
    int count[3];
    int *first; // (cells) first grain, or -1
    int *next;  // (n_particle) next grain of the same cell, or -1
};

struct pairs {
    int32_t (*pair)[2];
    int count, capacity;
};

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

static void bounds(const struct packing *packing, int axis, double *low, double *high)
{
    *low = component(packing->lower, axis);
    *high = component(packing->upper, axis);
    if (packing->periodic[axis]) return;
    for (int i = 0; i < packing->n_particle; i++) {
        const double at = component(packing->position[i], axis);
        *low = at < *low ? at : *low;
        *high = at > *high ? at : *high;
    }
}

static int cell_along(const struct cells *cells, const struct packing *packing, int i,
                      int axis)
{
    const double place =
        (component(packing->position[i], axis) - component(cells->origin, axis)) /
        component(cells->width, axis);
    const int n = cells->count[axis];
    if (packing->periodic[axis]) return (int)((long)floor(place) % n + n) % n;
    return place < 0 ? 0 : place >= n ? n - 1 : (int)place;
}

static struct cells fill_cells(const struct packing *packing, double reach)
{
    struct cells cells = {0};
    for (int axis = 0; axis < 3; axis++) {
        double low, high;
        bounds(packing, axis, &low, &high);
        const double wanted = floor((high - low) / reach);
        cells.count[axis] = wanted < 1            ? 1
                            : wanted > MOST_CELLS ? MOST_CELLS
                                                  : (int)wanted;
        set_component(&cells.origin, axis, low);
        set_component(&cells.width, axis, (high - low) / cells.count[axis]);
    }
    const size_t total =
        (size_t)cells.count[0] * (size_t)cells.count[1] * (size_t)cells.count[2];
    cells.first = NEW_ARRAY(int, total);
    cells.next = NEW_ARRAY(int, packing->n_particle);
    memset(cells.first, -1, total * sizeof *cells.first);
    for (int i = packing->n_particle - 1; i >= 0; i--) {
        const int x = cell_along(&cells, packing, i, 0);
        const int y = cell_along(&cells, packing, i, 1);
        const int z = cell_along(&cells, packing, i, 2);
        int *head = &cells.first[x + cells.count[0] * (y + cells.count[1] * z)];
        cells.next[i] = *head;
        *head = i;
    }
    return cells;
}

// The distinct cells at AT-1, AT, AT+1 along an axis; fewer than three in a narrow box.
static int cells_around(int at, int count, bool periodic, int around[3])
{
    int found = 0;
    for (int step = -1; step <= 1; step++) {
        int cell = at + step;
        if (periodic) cell = (cell + count) % count;
        if (cell < 0 || cell >= count) continue;
        bool known = false;
        for (int k = 0; k < found; k++)
            known = known || around[k] == cell;
        if (!known) around[found++] = cell;
    }
    return found;
}

static void pair_with_cell(const struct packing *packing, const struct cells *cells,
                           int cell, int i, double gap, struct pairs *pairs)
{
    for (int j = cells->first[cell]; j >= 0; j = cells->next[j]) {
        if (j <= i) continue;
        const double reach = (packing->radius[i] + packing->radius[j]) * (1 + gap);
        if (norm(nearest_image(packing, i, j)) > reach) continue;
        GROW_ARRAY(pairs->pair, pairs->count, pairs->capacity);
        pairs->pair[pairs->count][0] = i;
        pairs->pair[pairs->count++][1] = j;
    }
}

int compare_pairs(const void *a, const void *b)
{
    const int32_t *first = a, *second = b;
    if (first[0] != second[0]) return first[0] < second[0] ? -1 : 1;
    return (first[1] > second[1]) - (first[1] < second[1]);
}

int32_t (*neighbour_pairs(const struct packing *packing, double gap, int *count))[2]
{
    double largest = 0;
    for (int i = 0; i < packing->n_particle; i++)
        largest = packing->radius[i] > largest ? packing->radius[i] : largest;
    const struct cells cells = fill_cells(packing, 2 * largest * (1 + gap));
    struct pairs pairs = {0};
    for (int i = 0; i < packing->n_particle; i++) {
        int around[3][3], found[3];
        for (int axis = 0; axis < 3; axis++)
            found[axis] =
                cells_around(cell_along(&cells, packing, i, axis), cells.count[axis],
                             packing->periodic[axis], around[axis]);
        for (int z = 0; z < found[2]; z++)
            for (int y = 0; y < found[1]; y++)
                for (int x = 0; x < found[0]; x++)
                    pair_with_cell(packing, &cells,
                                   around[0][x] +
                                       cells.count[0] * (around[1][y] +
                                                         cells.count[1] * around[2][z]),
                                   i, gap, &pairs);
    }
    free(cells.first);
    free(cells.next);
    if (pairs.count)
        qsort(pairs.pair, (size_t)pairs.count, sizeof *pairs.pair, compare_pairs);
    *count = pairs.count;
    return pairs.pair;
}
