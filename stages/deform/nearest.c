// SPDX-License-Identifier: GPL-3.0-or-later
// Nearest neighbour by linked cells of about two points each: rings of cells around
// the query are searched until the next ring is farther away than the best found.
// Distances are those to the nearest image, d - L round(d / L) along axes that repeat;
// with about two points a cell the search is O(1) for points spread evenly, and right,
// if slow, for others. Of several at one distance the first is the nearest.
#include "nearest.h"

#include <stdlib.h>

struct places places_init(const struct packing *packing, int n, const struct vector *at)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    struct box_of_places box = {{0}, {0}};
    for (int axis = 0; axis < 3; axis++) {
        box.lower[axis] = component(packing->lower, axis);
        if (packing->periodic[axis]) box.period[axis] = component(edge, axis);
    }
    const double two = 2 * box_volume(edge) / fmax(n, 1); // places a cell
    return (struct places){packing, at,
                           linked_cells_init(&box, n, at, 0, NULL, cbrt(two))};
}

void places_free(struct places *places)
{
    linked_cells_free(&places->cells);
    *places = (struct places){0};
}

static double apart(const struct packing *packing, struct vector a, struct vector b)
{
    struct vector d = subtract(b, a);
    const struct vector edge = subtract(packing->upper, packing->lower);
    for (int axis = 0; axis < 3; axis++) {
        const double length = component(edge, axis);
        if (packing->periodic[axis])
            set_component(&d, axis,
                          component(d, axis) -
                              length * round(component(d, axis) / length));
    }
    return norm(d);
}

struct search {
    const struct places *places;
    struct vector from;
    int nearest;
    double least;
};

// Searches CELL, which may lie beyond the grid: wrapped if periodic, else skipped.
static void search_cell(struct search *search, const int cell[3])
{
    const struct places *places = search->places;
    const struct linked_cells *cells = &places->cells;
    int in[3];
    for (int axis = 0; axis < 3; axis++) {
        const int count = cells->count[axis];
        in[axis] = cell[axis];
        if (cells->repeats[axis])
            in[axis] = (cell[axis] % count + count) % count;
        else if (cell[axis] < 0 || cell[axis] >= count)
            return;
    }
    const int c = cell_number(cells, in);
    for (int k = cells->offset[c]; k < cells->offset[c + 1]; k++) {
        const int i = cells->member[k];
        const double here = apart(places->packing, search->from, places->at[i]);
        if (here < search->least || (here == search->least && i < search->nearest)) {
            search->least = here;
            search->nearest = i;
        }
    }
}

// The cells that are RING away from CENTRE along some axis, and no further along any.
static void search_ring(struct search *search, const int centre[3], int ring)
{
    for (int x = -ring; x <= ring; x++)
        for (int y = -ring; y <= ring; y++) {
            const bool rim = abs(x) == ring || abs(y) == ring;
            for (int z = -ring; z <= ring; z += rim || ring == 0 ? 1 : 2 * ring)
                search_cell(search,
                            (int[3]){centre[0] + x, centre[1] + y, centre[2] + z});
        }
}

int nearest_place(const struct places *places, struct vector from)
{
    struct search search = {places, from, -1, HUGE_VAL};
    const struct linked_cells *cells = &places->cells;
    int centre[3], most = 0;
    double width = HUGE_VAL;
    for (int axis = 0; axis < 3; axis++) {
        centre[axis] = cell_along(cells, axis, component(from, axis));
        most = cells->count[axis] > most ? cells->count[axis] : most;
        width = fmin(width, 1 / cells->per_length[axis]);
    }
    // What lies in the next ring is at least RING cells away.
    for (int ring = 0; ring <= most; ring++) {
        search_ring(&search, centre, ring);
        if (search.least <= ring * width) break;
    }
    return search.nearest;
}
