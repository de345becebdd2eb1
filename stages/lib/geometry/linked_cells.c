// SPDX-License-Identifier: GPL-3.0-or-later
// Places sorted into cells at least as wide as asked (linked cells): counting sort,
// O(n). Per axis
//     count = floor(length / width),  cell = floor((x - lower) count / length),
// length being the period or the extent of the places; while there are more than
// 2 members + 64 cells, the longest count is halved.
#include "geometry/linked_cells.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

int cell_along(const struct linked_cells *cells, int axis, double x)
{
    double at = (x - cells->lower[axis]) * cells->per_length[axis];
    if (cells->repeats[axis]) at -= cells->count[axis] * floor(at / cells->count[axis]);
    return (int)fmin(fmax(at, 0), cells->count[axis] - 1);
}

int cell_number(const struct linked_cells *cells, const int cell[3])
{
    return (cell[0] * cells->count[1] + cell[1]) * cells->count[2] + cell[2];
}

static int cell_of(const struct linked_cells *cells, struct vector place)
{
    int cell[3];
    for (int axis = 0; axis < 3; axis++)
        cell[axis] = cell_along(cells, axis, component(place, axis));
    return cell_number(cells, cell);
}

static void size_cells(struct linked_cells *cells, const struct box_of_places *box,
                       int n, const struct vector *place, double width, int members)
{
    double length[3];
    for (int axis = 0; axis < 3; axis++) {
        double lower = INFINITY, upper = -INFINITY;
        for (int i = 0; i < n; i++) {
            lower = fmin(lower, component(place[i], axis));
            upper = fmax(upper, component(place[i], axis));
        }
        cells->repeats[axis] = box->period[axis] > 0;
        if (cells->repeats[axis]) {
            lower = box->lower[axis];
            upper = lower + box->period[axis];
        }
        cells->lower[axis] = lower;
        length[axis] = fmax(upper - lower, width);
        cells->count[axis] = (int)fmin(floor(length[axis] / width), 1 << 20);
    }
    while ((double)cells->count[0] * cells->count[1] * cells->count[2] >
           2.0 * members + 64) {
        int longest = 0;
        for (int axis = 1; axis < 3; axis++)
            if (cells->count[axis] > cells->count[longest]) longest = axis;
        cells->count[longest] = (cells->count[longest] + 1) / 2;
    }
    for (int axis = 0; axis < 3; axis++)
        cells->per_length[axis] = cells->count[axis] / length[axis];
}

struct linked_cells linked_cells_init(const struct box_of_places *box, int n,
                                      const struct vector *place, int n_chosen,
                                      const int *chosen, double width)
{
    struct linked_cells cells = {0};
    const int members = chosen ? n_chosen : n;
    size_cells(&cells, box, n, place, width, members);
    const int n_cell = cells.count[0] * cells.count[1] * cells.count[2];
    cells.offset = NEW_ARRAY(int, n_cell + 2);
    cells.member = NEW_ARRAY(int, members);
    int *cell = NEW_ARRAY(int, members);
    for (int k = 0; k < members; k++) {
        cell[k] = cell_of(&cells, place[chosen ? chosen[k] : k]);
        cells.offset[cell[k] + 2]++;
    }
    for (int c = 0; c < n_cell; c++)
        cells.offset[c + 2] += cells.offset[c + 1];
    // Filling moves each offset one on, so that cell c ends where c + 1 begins.
    for (int k = 0; k < members; k++)
        cells.member[cells.offset[cell[k] + 1]++] = chosen ? chosen[k] : k;
    free(cell);
    return cells;
}

void linked_cells_free(struct linked_cells *cells)
{
    free(cells->offset);
    free(cells->member);
    *cells = (struct linked_cells){0};
}
