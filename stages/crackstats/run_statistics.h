// SPDX-License-Identifier: GPL-3.0-or-later
// The statistics of one run, over which means, intervals and tests are made.
#pragma once

// Cracks are broken bonds; those that the weight alone broke before drying do not
// count. Three in a row are normal, shear and total, which note_modes in ensemble.c
// relies on. run_statistics.c gives each its name in the report.
enum statistic {
    CRACKS_NORMAL, // broken by the normal stress, over the whole drying
    CRACKS_SHEAR,  // by the shear stress
    CRACKS_TOTAL,
    CRACKS_SHARE, // total over the bonds of the packing; NAN without bonds
    FIRST_NORMAL, // the same in the first drying period
    FIRST_SHEAR,
    FIRST_TOTAL,
    SECOND_NORMAL, // and after it
    SECOND_SHEAR,
    SECOND_TOTAL,
    CLUSTERS_COUNT,   // connected cracks (clusters.h)
    CLUSTERS_LARGEST, // broken bonds in the largest
    CLUSTERS_SPAN_X,  // 1: one of them spans the body along x; else 0
    CLUSTERS_SPAN_Y,
    CLUSTERS_SPAN_Z,
    FRAGMENTS_BEFORE,      // fragments (fragment_counts.h) when drying begins
    FRAGMENTS_COUNT,       // when it ends
    FRAGMENTS_LARGEST,     // grains in the largest, at the end
    FRAGMENTS_SINGLE,      // grains without an intact bond, at the end
    SHRINKAGE_LARGEST,     // of all snapshots (deformation.h); NAN without any
    SHRINKAGE_LAST,        // of the last snapshot
    SPRING_BACK,           // (largest - last) / largest; NAN if largest is not > 0
    FRONT_CORRELATION,     // of cracks with lost liquid; NAN without a drying
    FRONT_SATURATION,      // mean, over the cracks, of the saturation of their slice
    UNSETTLED_LOADS,       // loads that did not come to rest
    UNSETTLED_CRACKS,      // cracks that opened under them
    POLYGONS_FOUND,        // 1: there is a pattern (pattern.h), 0: none. From here on
                           // only where patterns are asked for
    POLYGONS_CRACK_AREA,   // crack columns over all
    POLYGONS_IN_CRACKS,    // of the broken lateral bonds
    POLYGONS_FLOOR_BROKEN, // of the bonds to held grains; NAN without any
    POLYGONS_COUNT,        // this and what follows: NAN without a pattern
    POLYGONS_AREA,         // mean, m2
    POLYGONS_AREA_OVER_H2,
    POLYGONS_MEDIAN_OVER_H2,
    POLYGONS_LENGTH_OVER_H,
    POLYGONS_LARGEST, // over the area of the box
    POLYGONS_THROUGH, // crack columns in sets that cut all heights
    POLYGONS_ISLANDS,
    POLYGONS_WIDTH, // m
    POLYGONS_AIR, // share of the pores along crack walls that hold gas; NAN: not known
    POLYGONS_OPENED, // over the area of the box
    JUNCTIONS_COUNT,
    JUNCTIONS_ANGLE, // mean of the largest of each, degrees
    JUNCTIONS_T,
    JUNCTIONS_Y,
    STATISTIC_COUNT
};

// Keys of a statistic in the report, where statistics with one group are together.
struct statistic_name {
    const char *group, *name; // "cracks", "total"
};
extern const struct statistic_name statistic_names[STATISTIC_COUNT];

// NAN: not known for this run.
struct run_statistics {
    double value[STATISTIC_COUNT];
};
