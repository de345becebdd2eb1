// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of squares of counts over the runs. With n runs
//     sd^2 = (n sum of squares - (sum)^2) / (n (n - 1)),
// a difference of nearly equal numbers where runs are alike. Counts are multiples of
// 1/2, their squares of 1/4, so sums and products are exact while they stay below 2^51,
// the difference has no rounding error and is never below 0: equal runs scatter by
// exactly 0.
//
// The third column is (normal + shear)^2 of each run, which the squares of both do not
// give. So squares must be taken run by run, before counts of several are added.
#include "scatter.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

struct squares squares_init(struct classes classes)
{
    const size_t n_slice = (size_t)classes.n_slice;
    const size_t n_interval = (size_t)classes.n_interval;
    struct squares squares = {0};
    squares.slice = allocate(n_slice, sizeof *squares.slice);
    squares.saturation = allocate(n_interval, sizeof *squares.saturation);
    squares.time = allocate(n_interval, sizeof *squares.time);
    return squares;
}

void squares_free(struct squares *squares)
{
    free(squares->slice);
    free(squares->saturation);
    free(squares->time);
    *squares = (struct squares){0};
}

static void add_squares(double (*sum)[COLUMN_COUNT], const double (*of)[MODE_COUNT],
                        int n)
{
    for (int k = 0; k < n; k++) {
        double both = 0;
        for (int mode = 0; mode < MODE_COUNT; mode++) {
            sum[k][mode] += of[k][mode] * of[k][mode];
            both += of[k][mode];
        }
        sum[k][MODE_COUNT] += both * both;
    }
}

void squares_add(struct squares *squares, const struct counts *run,
                 const struct orientation *orientation, struct classes classes)
{
    double all[1][MODE_COUNT];
    count_all(all[0], run);
    add_squares(squares->all, all, 1);
    add_squares(squares->period, run->period, PERIOD_COUNT);
    add_squares(squares->inclination, orientation->cracks, INCLINATION_CLASSES);
    add_squares(squares->slice, run->slice, classes.n_slice);
    add_squares(squares->saturation, run->saturation, classes.n_interval);
    add_squares(squares->time, run->time, classes.n_interval);
}

double counts_deviation(double sum, double squares, int runs)
{
    const double n = runs;
    return sqrt((n * squares - sum * sum) / (n * (n - 1)));
}
