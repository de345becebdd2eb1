// SPDX-License-Identifier: GPL-3.0-or-later
// The report crackstats.json of an ensemble.
#pragma once

#include "ensemble.h"

#include <jansson.h>

// Adds the tables, means over the runs: cracks, periods, profile, by_saturation,
// by_time, profiles, clusters, fragments, orientation, deformation, front; with scatter
// and intervals of CONFIDENCE in cracks, periods, profile, by_saturation, by_time and
// orientation.
void report_tables(json_t *report, const struct ensemble *ensemble, double confidence);

// Adds patterns: the map of each run, where patterns were asked for.
void report_patterns(json_t *report, const struct ensemble *ensemble);

// Adds what the intervals are of, and the statistics: mean over the runs, their sd and
// confidence_interval (null for one run), those of each run, and the test of the groups
// (null without groups).
struct groups {
    int first;   // runs in the first, tested against the others; 0: no test
    bool paired; // both groups have the same size, and runs are paired in their order
};
void report_statistics(json_t *report, const struct ensemble *ensemble,
                       double confidence, struct groups groups);

// Whole numbers as integers: one run has no halves. What is not finite is null.
json_t *json_value(double value);
