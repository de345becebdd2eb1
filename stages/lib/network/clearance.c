// SPDX-License-Identifier: GPL-3.0-or-later
// The least clearance of a throat, m: from those grains beside it, then from larger
// grains in the cells around it (clearance.h says why only those). A grain matters only
// if
//     |centre - middle| < half + least + radius,
// with `half` of the throat's length and `least` the clearance so far; this spares most
// of them the distance to a segment.
//
// A grain nearer than `least` reaches into the box around the throat with that margin.
// Cells list every grain that, larger by `reach`, would meet them, so the margin is
// less by `reach`: mostly one cell is enough. Lists begin with the largest grains: the
// first one that is not larger than `largest` ends the search. Cells are chosen by the
// first `least`; as it falls there are some too many, never too few.
//
// Where the box repeats, cells are counted on beyond its sides: their number is brought
// back, and SHIFT puts their grains where the throat sees them.
#include "network/clearance.h"

// What look_in_cell needs of the throat; m.
struct throat {
    const struct vector *end;
    struct vector middle;
    double half;    // of its length
    double largest; // grains that are no larger cannot be nearer
    double least;   // the clearance so far
};

// Looks at the grains of CELL, counted along the axes.
static void look_in_cell(const struct sphere_cells *grains, const int cell[3],
                         struct throat *throat)
{
    int64_t place = 0;
    struct vector shift = {0};
    for (int axis = 0; axis < 3; axis++) {
        const int count = grains->count[axis];
        int within = cell[axis];
        if (within < 0 || within >= count) { // in another repetition of the box
            const int box = (int)floor((double)within / count);
            within -= box * count;
            set_component(&shift, axis, box * grains->period[axis]);
        }
        place = place * count + within;
    }
    const struct vector from = subtract(throat->middle, shift);
    const struct sphere *end = grains->sphere + grains->offset[place + 1];
    for (const struct sphere *grain = grains->sphere + grains->offset[place];
         grain < end && grain->radius > throat->largest; grain++) {
        const struct vector apart = subtract(grain->centre, from);
        const double near = throat->half + throat->least + grain->radius;
        if (dot(apart, apart) >= near * near) continue; // as most are
        const double here = clearance_of(add(grain->centre, shift), grain->radius,
                                         throat->end, CLEARANCE_SEGMENT);
        if (here < throat->least) throat->least = here;
    }
}

// Nothing to look for where the throat touches a grain already, or where no grain is
// larger than those beside it, as with grains of one size.
double least_clearance(const struct sphere_cells *grains, const struct vector end[2],
                       struct clear_way way)
{
    if (!(way.least > 0) || grains->largest <= way.largest) return way.least;
    const struct vector half = scale(0.5, subtract(end[1], end[0]));
    struct throat throat = {end, add(end[0], half), norm(half), way.largest, way.least};
    int first[3], last[3], cell[3];
    for (int axis = 0; axis < 3; axis++) {
        const double x = component(throat.middle, axis);
        const double beyond = fabs(component(half, axis)) + way.least - grains->reach;
        const double margin = beyond > 0 ? beyond : 0;
        first[axis] = sphere_cell_along(grains, axis, x - margin);
        last[axis] = sphere_cell_along(grains, axis, x + margin);
    }
    for (cell[0] = first[0]; cell[0] <= last[0]; cell[0]++)
        for (cell[1] = first[1]; cell[1] <= last[1]; cell[1]++)
            for (cell[2] = first[2]; cell[2] <= last[2]; cell[2]++)
                look_in_cell(grains, cell, &throat);
    return throat.least;
}
