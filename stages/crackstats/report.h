// SPDX-License-Identifier: GPL-3.0-or-later
// crackstats.json out of a study.
#ifndef CRAQUELURE_CRACKSTATS_REPORT_H
#define CRAQUELURE_CRACKSTATS_REPORT_H

#include "ensemble.h"

#include <jansson.h>

// Puts in tables that are means over the runs: cracks, periods, profile, by_saturation,
// by_time, profiles, clusters, fragments, orientation, deformation, front; with their
// scatter and intervals of CONFIDENCE in cracks, periods, profile, by_saturation,
// by_time and orientation.
void report_tables(json_t *report, const struct ensemble *ensemble, double confidence);

// Puts in what intervals are of, and the facts: mean, sd and confidence_interval over
// the runs (null for one run), each run's own; and the test of the groups.
struct groups {
    int first;   // runs in the first, tested against the others; 0: no test
    bool paired; // the groups are as large, and runs belong together in their order
};
void report_statistics(json_t *report, const struct ensemble *ensemble,
                       double confidence, struct groups groups);

// Whole numbers as integers: one run has no halves. What is not finite is null.
json_t *json_value(double value);

#endif
