// SPDX-License-Identifier: GPL-3.0-or-later
// How wide the way between grains is along a throat.
//
// A throat lies between the cells of the grains beside it: no grain has less power
// (distance^2 - radius^2; in a Voronoi diagram distance) to any point of it than they
// have. With p that power, a grain of radius R beside it has the clearance
// sqrt(p + R^2) - R there, which falls with R: the largest of them is the nearest. Of
// the other grains, with no less power, none that is no larger can be nearer; a larger
// one can. So only grains larger than all beside a throat are looked for.
#pragma once

#include "geometry/packing.h"
#include "geometry/sphere_cells.h"

enum clearance {
    CLEARANCE_SEGMENT, // least distance from the throat itself to any grain
    CLEARANCE_LINE,    // [K 3.7]: from the infinite line through it to those beside it
    CLEARANCE_BESIDE   // from the throat itself to those beside it
};

// How far the surface of a grain (CENTRE, RADIUS, m) is from the throat between END
// [K 3.7, 3.8], m; below 0 where they overlap. With t the share of the way from END[0]
// to END[1] at which the centre's foot lies (cut to 0..1 but for CLEARANCE_LINE),
//     clearance = |centre - (end[0] + t (end[1] - end[0]))| - radius.
// A throat without length is a point. m throughout.
static inline double clearance_of(struct vector centre, double radius,
                                  const struct vector end[2], enum clearance how)
{
    const struct vector along = subtract(end[1], end[0]);
    const struct vector to = subtract(centre, end[0]);
    const double length2 = dot(along, along);
    double t = length2 > 0 ? dot(to, along) / length2 : 0;
    if (how != CLEARANCE_LINE) t = t < 0 ? 0 : t > 1 ? 1 : t;
    return norm(subtract(to, scale(t, along))) - radius;
}

// What is known of the clearance of a throat, m. LARGEST is the bound for those that
// least_clearance looks for.
struct clear_way {
    double least;   // to the grains seen so far
    double largest; // radius of the grains beside it
};

// To begin with; then clear_of for each grain beside the throat, in any order and as
// often as it is met: HUGE_VAL remains where there is none.
static const struct clear_way nothing_beside = {HUGE_VAL, 0};

// With one more grain beside the throat.
static inline struct clear_way clear_of(struct clear_way way, struct vector centre,
                                        double radius, const struct vector end[2],
                                        enum clearance how)
{
    const double here = clearance_of(centre, radius, end, how);
    return (struct clear_way){here < way.least ? here : way.least,
                              radius > way.largest ? radius : way.largest};
}

// The least clearance of the throat between END, which is WAY by the grains beside it:
// over those and all larger ones of GRAINS. Where the throat touches one already the
// clearance stays what it is, at most 0. END must be in the box that GRAINS were made
// for, or not far beyond, in the same unit. O(1) in packings of any sizes. Safe for
// several threads: GRAINS are only read. Needs WAY by all grains beside the throat:
// what it does not search, it takes from there.
double least_clearance(const struct sphere_cells *grains, const struct vector end[2],
                       struct clear_way way);
