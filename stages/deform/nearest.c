// SPDX-License-Identifier: GPL-3.0-or-later
#include "nearest.h"

#include "basics/memory.h"

#include <stdlib.h>

static int cell_along(const struct places *places, int axis, struct vector x)
{
    const int count = places->count[axis];
    double at = (component(x, axis) - component(places->packing->lower, axis)) /
                places->width[axis];
    if (places->packing->periodic[axis]) at -= count * floor(at / count);
    return (int)fmin(fmax(at, 0), count - 1);
}

static int cell_number(const struct places *places, const int cell[3])
{
    return (cell[0] * places->count[1] + cell[1]) * places->count[2] + cell[2];
}

static int cell_of(const struct places *places, struct vector x)
{
    int cell[3];
    for (int axis = 0; axis < 3; axis++)
        cell[axis] = cell_along(places, axis, x);
    return cell_number(places, cell);
}

struct places places_make(const struct packing *packing, int n, const struct vector *at)
{
    struct places places = {.packing = packing, .n = n, .at = at};
    const int along = (int)fmin(512, fmax(1, floor(cbrt(n / 2.0))));
    const struct vector edge = subtract(packing->upper, packing->lower);
    for (int axis = 0; axis < 3; axis++) {
        places.count[axis] = along;
        places.width[axis] = component(edge, axis) / along;
    }
    const int n_cell = along * along * along;
    places.offset = NEW_ARRAY(int, n_cell + 2);
    places.member = NEW_ARRAY(int, n);
    for (int i = 0; i < n; i++)
        places.offset[cell_of(&places, at[i]) + 2]++;
    for (int c = 0; c < n_cell; c++)
        places.offset[c + 2] += places.offset[c + 1];
    for (int i = 0; i < n; i++)
        places.member[places.offset[cell_of(&places, at[i]) + 1]++] = i;
    return places;
}

void places_free(struct places *places)
{
    free(places->offset);
    free(places->member);
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

// CELL may lie beyond the cells.
static void look_in(struct search *search, const int cell[3])
{
    const struct places *places = search->places;
    int in[3];
    for (int axis = 0; axis < 3; axis++) {
        const int count = places->count[axis];
        in[axis] = cell[axis];
        if (places->packing->periodic[axis])
            in[axis] = (cell[axis] % count + count) % count;
        else if (cell[axis] < 0 || cell[axis] >= count)
            return;
    }
    const int c = cell_number(places, in);
    for (int k = places->offset[c]; k < places->offset[c + 1]; k++) {
        const int i = places->member[k];
        const double here = apart(places->packing, search->from, places->at[i]);
        if (here < search->least || (here == search->least && i < search->nearest)) {
            search->least = here;
            search->nearest = i;
        }
    }
}

// The cells that are RING away from CENTRE along some axis, and no further along any.
static void look_around(struct search *search, const int centre[3], int ring)
{
    for (int x = -ring; x <= ring; x++)
        for (int y = -ring; y <= ring; y++) {
            const bool rim = abs(x) == ring || abs(y) == ring;
            for (int z = -ring; z <= ring; z += rim || ring == 0 ? 1 : 2 * ring)
                look_in(search, (int[3]){centre[0] + x, centre[1] + y, centre[2] + z});
        }
}

int nearest_place(const struct places *places, struct vector from)
{
    struct search search = {places, from, -1, HUGE_VAL};
    int centre[3], most = 0;
    double width = HUGE_VAL;
    for (int axis = 0; axis < 3; axis++) {
        centre[axis] = cell_along(places, axis, from);
        most = places->count[axis] > most ? places->count[axis] : most;
        width = fmin(width, places->width[axis]);
    }
    // What lies in the next ring is at least RING cells away.
    for (int ring = 0; ring <= most; ring++) {
        look_around(&search, centre, ring);
        if (search.least <= ring * width) break;
    }
    return search.nearest;
}
