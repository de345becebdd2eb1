// SPDX-License-Identifier: GPL-3.0-or-later
// Names of the statistics in the report: keys of mean, sd, confidence_interval, each
// and test. Readers depend on them: never rename.
#include "run_statistics.h"

const struct statistic_name statistic_names[STATISTIC_COUNT] = {
    [CRACKS_NORMAL] = {"cracks", "normal"},
    [CRACKS_SHEAR] = {"cracks", "shear"},
    [CRACKS_TOTAL] = {"cracks", "total"},
    [CRACKS_SHARE] = {"cracks", "share"},
    [FIRST_NORMAL] = {"first", "normal"},
    [FIRST_SHEAR] = {"first", "shear"},
    [FIRST_TOTAL] = {"first", "total"},
    [SECOND_NORMAL] = {"second", "normal"},
    [SECOND_SHEAR] = {"second", "shear"},
    [SECOND_TOTAL] = {"second", "total"},
    [CLUSTERS_COUNT] = {"clusters", "count"},
    [CLUSTERS_LARGEST] = {"clusters", "largest"},
    [CLUSTERS_SPAN_X] = {"clusters", "span_x"},
    [CLUSTERS_SPAN_Y] = {"clusters", "span_y"},
    [CLUSTERS_SPAN_Z] = {"clusters", "span_z"},
    [FRAGMENTS_BEFORE] = {"fragments", "before"},
    [FRAGMENTS_COUNT] = {"fragments", "count"},
    [FRAGMENTS_LARGEST] = {"fragments", "largest"},
    [FRAGMENTS_SINGLE] = {"fragments", "single"},
    [SHRINKAGE_LARGEST] = {"shrinkage", "largest"},
    [SHRINKAGE_LAST] = {"shrinkage", "last"},
    [SPRING_BACK] = {"shrinkage", "spring_back"},
    [FRONT_CORRELATION] = {"front", "correlation"},
    [FRONT_SATURATION] = {"front", "saturation"},
    [UNSETTLED_LOADS] = {"unsettled", "loads"},
    [UNSETTLED_CRACKS] = {"unsettled", "cracks"},
};
