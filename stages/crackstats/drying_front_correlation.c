// SPDX-License-Identifier: GPL-3.0-or-later
// Cracks and liquid by slices of the height. Over all slices s and intervals k of the
// network's saturation, Pearson's correlation of
//     left = S_s(k - 1) - S_s(k)    (saturation that the slice loses in the interval)
//     opened = cracks that open in the slice in the interval
// says whether cracks open where the liquid leaves. Also counted: the saturation of the
// slice in which each crack opens. Before the first interval a slice has what the
// drying begins with, S_s(-1): 1 in a full body, less in one that begins partly empty.
// Sums over runs scale `left`, which leaves the correlation as it is for means.
#include "drying_front_correlation.h"

#include "basics/memory.h"

#include <gsl/gsl_statistics_double.h>
#include <stdlib.h>

struct drying_front drying_front_init(struct classes classes)
{
    const size_t n_slice = (size_t)classes.n_slice;
    return (struct drying_front){
        .first = NEW_ARRAY(double, n_slice),
        .slice = NEW_ARRAY(double, (size_t)classes.n_interval *n_slice)};
}

void drying_front_free(struct drying_front *front)
{
    free(front->first);
    free(front->slice);
    *front = (struct drying_front){0};
}

static void add_each(double *sum, const double *more, size_t n)
{
    for (size_t k = 0; k < n; k++)
        sum[k] += more[k];
}

static void add_slices(struct drying_front *front, const struct liquid *liquid,
                       struct classes classes)
{
    double *time = NEW_ARRAY(double, classes.n_interval);
    for (int k = 0; k < classes.n_interval; k++)
        time[k] = time_of_saturation(liquid, (classes.n_interval - k - 1.0) /
                                                 classes.n_interval);
    double *slice =
        slice_saturations(liquid, classes.n_slice, time, classes.n_interval);
    double *first = slice_saturations(liquid, classes.n_slice, liquid->record.time, 1);
    const size_t n_slice = (size_t)classes.n_slice;
    add_each(front->slice, slice, (size_t)classes.n_interval * n_slice);
    add_each(front->first, first, n_slice);
    free(first);
    free(slice);
    free(time);
}

void drying_front_add(struct drying_front *front, const struct run *run,
                      const struct liquid *liquid, struct classes classes)
{
    add_slices(front, liquid, classes);
    double *slice = slice_saturations(liquid, classes.n_slice, run->time, run->n_crack);
    for (int k = 0; k < run->n_crack; k++) {
        const double *row = slice + (size_t)k * (size_t)classes.n_slice;
        const struct slices in =
            slices_of_bond(&run->packing, run->bond[k], classes.n_slice);
        for (int half = 0; half < 2; half++) {
            const double local = row[in.slice[half]];
            if (isnan(local)) continue; // never any liquid there
            front->local[class_of(1 - local, LOCAL_CLASSES)] += 0.5;
            front->local_sum += 0.5 * local;
            front->cracks += 0.5;
        }
    }
    free(slice);
}

void drying_front_sum(struct drying_front *sum, const struct drying_front *front,
                      struct classes classes)
{
    const size_t n_slice = (size_t)classes.n_slice;
    add_each(sum->slice, front->slice, (size_t)classes.n_interval * n_slice);
    add_each(sum->first, front->first, n_slice);
    for (int k = 0; k < LOCAL_CLASSES; k++)
        sum->local[k] += front->local[k];
    sum->local_sum += front->local_sum;
    sum->cracks += front->cracks;
}

double front_correlation(const double *first, const double *slice, const double *place,
                         struct classes classes)
{
    const int n_slice = classes.n_slice, n = classes.n_interval * n_slice;
    double *left = NEW_ARRAY(double, n), *opened = NEW_ARRAY(double, n);
    size_t count = 0;
    for (int k = 0; k < n; k++) {
        if (isnan(slice[k])) continue;
        left[count] = (k < n_slice ? first[k] : slice[k - n_slice]) - slice[k];
        opened[count++] = place[k];
    }
    double correlation = NAN;
    if (count > 1 && gsl_stats_variance(left, 1, count) > 0 &&
        gsl_stats_variance(opened, 1, count) > 0)
        correlation = gsl_stats_correlation(left, 1, opened, 1, count);
    free(left);
    free(opened);
    return correlation;
}
