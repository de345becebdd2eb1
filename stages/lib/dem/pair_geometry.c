// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/engine.h"

struct pair_geometry pair_geometry(const struct dem *dem, int pair, double back)
{
    const struct pair_group *g = &dem->pairs.group[pair / PAIRS_IN_GROUP];
    const int lane = pair % PAIRS_IN_GROUP;
    const int i = first_grain(g, lane), j = second_grain(g, lane);
    const struct vector moved = subtract(as_vector(dem->place[j].displacement),
                                         as_vector(dem->place[i].displacement));
    const struct vector moving =
        subtract(as_vector(dem->motion[j].linear), as_vector(dem->motion[i].linear));
    const struct vector apart = subtract(moved, scale(back * dem->time_step, moving));
    const struct vector start = lane_vector(g->separation, lane);
    const struct vector separation = add(start, apart);
    const double length = norm(separation);

    struct pair_geometry lie;
    lie.normal = scale(1 / length, separation);
    lie.stretch = dot(apart, add(start, separation)) / (length + g->distance[lane]);
    lie.overlap = g->overlap[lane] - lie.stretch;
    const double radius = dem->place[i].radius;
    const double shared = dem->unstressed ? radius + dem->place[j].radius -
                                                g->distance[lane] - lie.stretch
                                          : lie.overlap;
    const struct vector centre =
        subtract(add(dem->start[i], as_vector(dem->place[i].displacement)),
                 scale(back * dem->time_step, as_vector(dem->motion[i].linear)));
    lie.position = add(centre, scale(radius - 0.5 * shared, lie.normal));
    return lie;
}
