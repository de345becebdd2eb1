// SPDX-License-Identifier: GPL-3.0-or-later
// crackstats.json out of a study.
#ifndef CRAQUELURE_CRACKSTATS_REPORT_H
#define CRAQUELURE_CRACKSTATS_REPORT_H

#include "study.h"

#include <jansson.h>

// Puts in tables that are means over the runs: cracks, periods, profile, by_saturation,
// by_time, profiles, clusters, fragments, orientation, deformation, front.
void report_tables(json_t *report, const struct study *study);

// Puts in the facts: mean, sd and confidence_interval over the runs (null for one run),
// each run's own; and, where FIRST_GROUP is not 0, the test of the first so many runs
// against the others.
void report_facts(json_t *report, const struct study *study, double confidence,
                  int first_group);

// Whole numbers as integers: one run has no halves. What is not finite is null.
json_t *json_value(double value);

#endif
