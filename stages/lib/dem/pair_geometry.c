// SPDX-License-Identifier: GPL-3.0-or-later
// Distance, overlap and contact point of one pair, as pair_kinematics.h finds them for
// many: for observers, energies and the stability limit. With x the separation now and
// x0 at the start, du = x - x0,
//     stretch = |x| - |x0| = du.(x0 + x) / (|x0| + |x|),  overlap = overlap at start -
//     stretch.
#include "dem/engine.h"

struct pair_geometry pair_geometry(const struct dem *dem, int pair, double back)
{
    const struct pair_group *g = &dem->pairs.group[pair / PAIRS_IN_GROUP];
    const int lane = pair % PAIRS_IN_GROUP;
    const int i = first_grain(g, lane), j = second_grain(g, lane);
    const struct vector moved = subtract(as_vector(dem->place[j].displacement),
                                         as_vector(dem->place[i].displacement));
    const struct vector moving =
        subtract(as_vector(velocity_of(dem, j)), as_vector(velocity_of(dem, i)));
    const struct vector apart = subtract(moved, scale(back * dem->time_step, moving));
    const struct vector start = lane_vector(g->separation, lane);
    const struct vector separation = add(start, apart);
    const double length = norm(separation);

    struct pair_geometry geometry;
    geometry.normal = scale(1 / length, separation);
    geometry.stretch =
        dot(apart, add(start, separation)) / (length + g->distance[lane]);
    geometry.overlap = g->overlap[lane] - geometry.stretch;
    const double radius = dem->place[i].radius;
    geometry.shared = dem->unstressed ? radius + dem->place[j].radius -
                                            g->distance[lane] - geometry.stretch
                                      : geometry.overlap;
    const struct vector centre =
        subtract(add(dem->start[i], as_vector(dem->place[i].displacement)),
                 scale(back * dem->time_step, as_vector(velocity_of(dem, i))));
    geometry.position =
        add(centre, scale(radius - 0.5 * geometry.shared, geometry.normal));
    return geometry;
}
