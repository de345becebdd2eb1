// SPDX-License-Identifier: GPL-3.0-or-later
// The scatter over the runs of the counts in each period, slice, interval and
// inclination.
#ifndef CRAQUELURE_CRACKSTATS_SCATTER_H
#define CRAQUELURE_CRACKSTATS_SCATTER_H

#include "count.h"
#include "orientation.h"

enum { COLUMN_COUNT = MODE_COUNT + 1 }; // the modes, and both together

// Sums over the runs of the squares of their counts.
struct squares {
    double all[1][COLUMN_COUNT];
    double period[PERIOD_COUNT][COLUMN_COUNT];
    double inclination[INCLINATION_CLASSES][COLUMN_COUNT];
    double (*slice)[COLUMN_COUNT];      // (n_slice)
    double (*saturation)[COLUMN_COUNT]; // (n_interval)
    double (*time)[COLUMN_COUNT];       // (n_interval)
};

struct squares squares_new(struct classes classes);
void squares_free(struct squares *squares);

// Adds the counts of one RUN and its cracks by ORIENTATION.
void squares_add(struct squares *squares, const struct counts *run,
                 const struct orientation *orientation, struct classes classes);

// Standard deviation (n - 1) of RUNS counts, two or more, from their sum and the sum of
// their squares: whole numbers, whose difference rounding does not touch.
double counts_deviation(double sum, double squares, int runs);

#endif
