// SPDX-License-Identifier: GPL-3.0-or-later
// Junctions: where three or more polygons meet, and the angles between cracks there.
#pragma once

#include "polygons.h"

struct junctions {
    int count;           // all
    int measured;        // with borders that a circle about them crosses, 3 or more
    double mean_largest; // degrees: mean over those of the largest angle of each
    double t_share;      // of those: largest angle above 155 degrees
    double y_share;      // largest angle below 135 degrees
};

// The junctions of a pattern, found on the map of columns, so angles are no finer than
// these allow. All 0 where there is no pattern. O(columns + corners^2). Three borders
// that meet evenly give 120 degrees and count as Y, a border that ends at the side of
// another gives 180 and counts as T.
struct junctions find_junctions(const struct columns *columns,
                                const struct polygons *polygons);
