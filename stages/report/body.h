// SPDX-License-Identifier: GPL-3.0-or-later
// The body as arrays: grains, throats, bonds, and the forces at some moments. Arrays
// are named by what they belong to: grain.*, node.*, throat.*, bond.*, load.*,
// moment.*; each by the number of grains, nodes and so on. Distances are in steps of
// `grid`, times are keys (course.h).
#pragma once

#include "course.h"

struct shown_body {
    json_t *scales;       // what whole numbers of the arrays are multiples of
    double largest_load;  // arrow of any grain at any time, N or m/s; 0: none
    int heaviest;         // the grain under it
    double heaviest_time; // s
    int dry_throats;      // that never hold liquid: left out
    int refilled;         // throats that emptied, filled and emptied again
    int n_moment;         // loads that are shown
    int *moment;          // (n_moment) which
    struct grid {         // that places are put on
        struct vector origin;
        double step; // m
    } grid;
};

// Puts RUN into ARRAYS: lengths in steps of at most 1/500 of the smallest radius, so
// that nothing is further off than a thousandth; forces in 1/127 of the largest. COURSE
// must be of RUN. MOST_MOMENTS >= 1 is how many loads are shown with all their forces.
// The caller frees with shown_body_free.
struct shown_body put_body(struct arrays *arrays, const struct run *run,
                           const struct course *course, int most_moments);
void shown_body_free(struct shown_body *body);

// The whole number of steps along AXIS at which POINT is. AXIS 0 to 2; rounded to the
// nearest.
uint32_t on_grid(const struct grid *grid, struct vector point, int axis);
