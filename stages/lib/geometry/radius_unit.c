// SPDX-License-Identifier: GPL-3.0-or-later
// Grains whose radii are in their own unit fill phi of the room between their centres:
//     phi = sum of 4/3 pi r^3 / room, room = product of the edges in which the middle
//           80 % of the centres lie, each over 0.8: a few lost grains do not count,
// some tenths where they touch, some units where diameters were given. A unit 1000
// times too small makes phi 1e9 times too small. No body and no cloud of grains is as
// thin as that, and none as dense the other way: more than six powers of ten lie
// between what is taken for a body and what for another unit.
#include "geometry/radius_unit.h"

#include "basics/memory.h"
#include "geometry/auxiliary.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>

enum { FEWEST = 20 }; // with fewer the room is too rough
static const double THINNEST = 0.03, DENSEST = 8;

// The edge in which the middle 80 % of the centres lie, over 0.8, m.
static double edge_of(const struct packing *packing, int axis, double *place)
{
    int n = 0;
    for (int i = 0; i < packing->n_particle; i++)
        if (!is_auxiliary(packing, i))
            place[n++] = component(packing->position[i], axis);
    if (n < FEWEST) return 0;
    const size_t count = (size_t)n, tenth = count / 10;
    const double upper = gsl_stats_select(place, 1, count, count - 1 - tenth);
    return (upper - gsl_stats_select(place, 1, count, tenth)) / 0.8;
}

double radius_unit(const struct packing *packing)
{
    static const double unit[] = {1e3, 1e6, 1e-3, 1e-6};
    double *place = NEW_ARRAY(double, packing->n_particle), edge[3], phi = 0;
    for (int axis = 0; axis < 3; axis++)
        edge[axis] = edge_of(packing, axis, place);
    free(place);
    if (!(edge[0] > 0 && edge[1] > 0 && edge[2] > 0)) return 1;
    for (int i = 0; i < packing->n_particle; i++) {
        const double r = is_auxiliary(packing, i) ? 0 : packing->radius[i];
        phi += 4 * M_PI / 3 * (r / edge[0]) * (r / edge[1]) * (r / edge[2]);
    }
    for (int k = 0; k < 4; k++) {
        const double then = phi * pow(unit[k], 3);
        if (then >= THINNEST && then <= DENSEST) return unit[k];
    }
    return 1;
}
