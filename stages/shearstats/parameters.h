// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of shearstats. Members are in the order and the units of the table in
// parameters.c: lengths in m, times in s, rates in 1/s; the texts of `--help` say what
// each does. NAN and NULL: not given, then begin_study chooses from the first motion.
#pragma once

#include "parameters/parameters.h"

#include <stdint.h>

// Choices are stored as the place of their text in the table.
enum coordinates { COORDINATES_CARTESIAN, COORDINATES_CYLINDRICAL };
// Which part of a split-bottom cell turns.
enum turning { TURNING_OUTER, TURNING_INNER };

// RATE decides whether there is a cell at all: without it LEVELS, the radii and the
// parts are not used.
struct shearstats_parameters {
    int coordinates;
    double axis_point[3], axis_direction[3];
    double smoothing_length, spacing;
    unsigned along; // bit k: axis k has more than one cell
    double lower[3], upper[3];
    double from, to;
    int64_t blocks;
    double confidence;
    double rate;
    int turning;
    int64_t levels;
    double level_lower, level_upper, inner_radius, outer_radius;
    const char *walls, *groups;
    double least_rate, least_fraction, margin;
    double class_width;
};

extern const struct parameter shearstats_table[];

// Exits 65 at values that do not go together. Bounds against each other, an axis of no
// length, a window that ends before it begins, and a cell that has no rotation or no
// axis.
void check_shearstats_parameters(const struct shearstats_parameters *parameters);
