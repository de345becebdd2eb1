// SPDX-License-Identifier: GPL-3.0-or-later
// The statistics of one run, over which means, intervals and tests are made.
#ifndef CRAQUELURE_CRACKSTATS_RUN_STATISTICS_H
#define CRAQUELURE_CRACKSTATS_RUN_STATISTICS_H

enum statistic {
    CRACKS_NORMAL,
    CRACKS_SHEAR,
    CRACKS_TOTAL,
    CRACKS_SHARE,
    FIRST_NORMAL,
    FIRST_SHEAR,
    FIRST_TOTAL,
    SECOND_NORMAL,
    SECOND_SHEAR,
    SECOND_TOTAL,
    CLUSTERS_COUNT,
    CLUSTERS_LARGEST,
    CLUSTERS_SPAN_X,
    CLUSTERS_SPAN_Y,
    CLUSTERS_SPAN_Z,
    FRAGMENTS_BEFORE,
    FRAGMENTS_COUNT,
    FRAGMENTS_LARGEST,
    FRAGMENTS_SINGLE,
    SHRINKAGE_LARGEST,
    SHRINKAGE_LAST,
    SPRING_BACK,
    FRONT_CORRELATION,
    FRONT_SATURATION,
    UNSETTLED_LOADS,
    UNSETTLED_CRACKS,
    STATISTIC_COUNT
};

struct statistic_name {
    const char *group, *name; // "cracks", "total"
};
extern const struct statistic_name statistic_names[STATISTIC_COUNT];

// NAN: not known for this run.
struct run_statistics {
    double value[STATISTIC_COUNT];
};

#endif
