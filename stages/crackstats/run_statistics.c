// SPDX-License-Identifier: GPL-3.0-or-later
// Names of the statistics in the report: keys of mean, sd, confidence_interval, each
// and test, as {group: {name: value}}. Readers depend on them: never rename.
//
// By enum statistic, so the order here is of no consequence; the order of groups in the
// report is that of the enum. Each statistic must be named, as report_statistics.c goes
// through all up to POLYGONS_FOUND and, with patterns, beyond. A name may come in
// several groups ("count", "largest"), but once in each. What each one means, its unit
// and where it is NAN is said in run_statistics.h.
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
    [POLYGONS_FOUND] = {"polygons", "found"},
    [POLYGONS_CRACK_AREA] = {"polygons", "crack_area"},
    [POLYGONS_IN_CRACKS] = {"polygons", "in_cracks"},
    [POLYGONS_FLOOR_BROKEN] = {"polygons", "floor_broken"},
    [POLYGONS_COUNT] = {"polygons", "count"},
    [POLYGONS_AREA] = {"polygons", "area"},
    [POLYGONS_AREA_OVER_H2] = {"polygons", "area_over_h2"},
    [POLYGONS_MEDIAN_OVER_H2] = {"polygons", "median_over_h2"},
    [POLYGONS_LENGTH_OVER_H] = {"polygons", "length_over_h"},
    [POLYGONS_LARGEST] = {"polygons", "largest"},
    [POLYGONS_THROUGH] = {"polygons", "through"},
    [POLYGONS_ISLANDS] = {"polygons", "islands"},
    [POLYGONS_WIDTH] = {"polygons", "width"},
    [POLYGONS_AIR] = {"polygons", "air"},
    [POLYGONS_OPENED] = {"polygons", "opened"},
    [JUNCTIONS_COUNT] = {"junctions", "count"},
    [JUNCTIONS_ANGLE] = {"junctions", "largest_angle"},
    [JUNCTIONS_T] = {"junctions", "t_share"},
    [JUNCTIONS_Y] = {"junctions", "y_share"},
};
