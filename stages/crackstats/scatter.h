// SPDX-License-Identifier: GPL-3.0-or-later
// The scatter over the runs of the counts in each period, slice, interval and
// inclination: kept as sums of squares, so that no run must be remembered.
#pragma once

#include "count.h"
#include "orientation.h"

enum { COLUMN_COUNT = MODE_COUNT + 1 }; // the modes, and both together

// Sums over the runs of the squares of their counts. Column MODE_COUNT has the square
// of both modes together, which is not the sum of their squares. It owns its arrays.
struct squares {
    double all[1][COLUMN_COUNT];
    double period[PERIOD_COUNT][COLUMN_COUNT];
    double inclination[INCLINATION_CLASSES][COLUMN_COUNT];
    double (*slice)[COLUMN_COUNT];      // (n_slice)
    double (*saturation)[COLUMN_COUNT]; // (n_interval)
    double (*time)[COLUMN_COUNT];       // (n_interval)
};

// All 0, in the shapes of CLASSES. The caller frees them with squares_free.
struct squares squares_init(struct classes classes);
void squares_free(struct squares *squares);

// Adds the squares of the counts of one RUN, and of its cracks by ORIENTATION. Both
// must be of this run alone, not sums.
void squares_add(struct squares *squares, const struct counts *run,
                 const struct orientation *orientation, struct classes classes);

// Standard deviation (n - 1) of the counts of RUNS runs, two or more, from their SUM
// and the sum of their SQUARES. Counts are multiples of 1/2, so both sums are exact and
// their difference has no rounding error. sqrt((n sum of squares - sum^2) / (n (n -
// 1))), 0 exactly where all runs are alike.
double counts_deviation(double sum, double squares, int runs);
