// SPDX-License-Identifier: GPL-3.0-or-later
// A part of a rectangle, bounded by straight sides: how much of a polygon or a line
// lies in it. The open side of a body as seen from above, for the exchange areas of the
// boundary layer. In m, or scaled; all in one unit.
#pragma once

#include <stdbool.h>

struct planar {
    double x, y;
};

// From 0 to SIZE; repeated along an axis where it is periodic, else ended there. A
// point and its repetitions are one point of the region.
struct rectangle {
    struct planar size;
    bool periodic_x, periodic_y;
};

// The region lies to the left of its sides, which form closed loops around it. Where
// the rectangle repeats they may lead around it and close nowhere: there the region is
// also given by parts, which do not overlap. It owns its arrays.
struct planar_region {
    int n_side;               // 0: all of the rectangle
    struct planar (*side)[2]; // (n_side) from [0] to [1]; ends of the rectangle along
                              // one axis are left out where it repeats along the other
    struct rectangle rectangle;

    int n_part;            // 0 where the rectangle does not repeat
    int *part_offset;      // (n_part + 1)
    struct planar *corner; // corners of part p: part_offset[p] to part_offset[p + 1],
                           // in one repetition of the rectangle
    struct planar (*extent)[2]; // (n_part) their lowest and highest coordinates
};

// Area of the part of a convex polygon in the region. Its N corners are
// counter-clockwise, relative to ORIGIN and near it. Rounding may make it a little
// negative.
double area_in_region(const struct planar_region *region, struct planar origin,
                      const struct planar *corner, int n);

// Length of the part of the line from FROM to TO (relative to ORIGIN) in the region.
double length_in_region(const struct planar_region *region, struct planar origin,
                        struct planar from, struct planar to);

// Whether the whole disc of radius DISTANCE around ORIGIN is in the region.
bool region_holds(const struct planar_region *region, struct planar origin,
                  double distance);

// What it owns; the region is empty then.
void planar_region_free(struct planar_region *region);
