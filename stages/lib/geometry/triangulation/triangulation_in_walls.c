// SPDX-License-Identifier: GPL-3.0-or-later
// From points in any order to cells between walls:
//     box_around            six walls: those asked for at 0 and `upper`, the others
//                           beyond all points, where they only end the triangulation;
//     insertion_order       an order in which inserting is fast;
//     triangulate_between   cells of points and all six walls, without those at walls
//                           that are not asked for;
//     numbering back        vertices k of the ordered points become order[k].
// Walls have negative numbers, -1 to -6, and stay as they are. A wall that is not asked
// for is farther from all points than they extend, by a length of 1: hence the advice
// that lengths be of the order of 1. There must be a point: the first one makes the
// first eight cells. O(n log n) for points that fill space.
#include "geometry/triangulation/triangulation_in_walls.h"

#include "basics/memory.h"
#include "geometry/triangulation/insertion_order.h"

#include <float.h>
#include <stdlib.h>

// All points lie between walls, for that is all that triangulate_between knows: along a
// direction without any they stand beyond all points.
static struct wall_box box_around(const struct vector *points, int n, unsigned walls,
                                  struct vector upper)
{
    struct wall_box box = {.upper = upper};
    for (int axis = 0; axis < 3; axis++) {
        double least = DBL_MAX, most = -DBL_MAX;
        for (int i = 0; i < n; i++) {
            least = fmin(least, component(points[i], axis));
            most = fmax(most, component(points[i], axis));
        }
        const double beyond = 1 + most - least;
        if (!(walls >> 2 * axis & 1)) set_component(&box.lower, axis, least - beyond);
        if (!(walls >> (2 * axis + 1) & 1))
            set_component(&box.upper, axis, most + beyond);
    }
    return box;
}

int triangulate_in_walls(const struct vector *points, const double *weights, int n,
                         unsigned walls, struct vector upper,
                         struct triangulation *triangulation)
{
    const struct wall_box box = box_around(points, n, walls, upper);
    int32_t *order = insertion_order(points, n);
    struct weighted_point *ordered = NEW_ARRAY(struct weighted_point, n);
    for (int k = 0; k < n; k++)
        ordered[k] =
            (struct weighted_point){points[order[k]], weights ? weights[order[k]] : 0};
    *triangulation = triangulate_between(ordered, n, &box, walls);
    for (int c = 0; c < triangulation->n_cell; c++)
        for (int k = 0; k < 4; k++) {
            int32_t *vertex = &triangulation->cell[c].vertex[k];
            if (*vertex >= 0) *vertex = order[*vertex];
        }
    free(order);
    free(ordered);
    if (triangulation->n_cell) return 0;
    triangulation_free(triangulation);
    return -1;
}
