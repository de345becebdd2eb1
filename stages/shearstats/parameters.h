// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of shearstats.
#ifndef CRAQUELURE_SHEARSTATS_PARAMETERS_H
#define CRAQUELURE_SHEARSTATS_PARAMETERS_H

#include "parameters/parameters.h"

#include <stdint.h>

enum coordinates { COORDINATES_CARTESIAN, COORDINATES_CYLINDRICAL };
enum turning { TURNING_OUTER, TURNING_INNER };

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

// Exits 65 at values that do not go together.
void check_shearstats_parameters(const struct shearstats_parameters *parameters);

#endif
