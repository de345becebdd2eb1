// SPDX-License-Identifier: GPL-3.0-or-later
#include "summarise.h"

#include "basics/memory.h"

#include <gsl/gsl_statistics_double.h>
#include <stdlib.h>

static const char *const modes[MODE_COUNT + 1] = {"normal", "shear", "total"};
static const char *const periods[PERIOD_COUNT] = {"first", "second"};

// What one number of a run is: a period (or both: PERIOD_COUNT) or a slice, and a mode
// (or both: MODE_COUNT).
struct selection {
    int period, slice, mode;
};

static double select_count(const struct counts *run, struct selection of)
{
    double sum = 0;
    for (int mode = 0; mode < MODE_COUNT; mode++) {
        if (of.mode != MODE_COUNT && of.mode != mode) continue;
        if (of.slice >= 0) sum += run->slice[of.slice][mode];
        for (int period = 0; of.slice < 0 && period < PERIOD_COUNT; period++)
            if (of.period == PERIOD_COUNT || of.period == period)
                sum += run->period[period][mode];
    }
    return sum;
}

// Whole counts are written as integers: one run has no halves.
static json_t *number(double value)
{
    return value == (double)(json_int_t)value ? json_integer((json_int_t)value)
                                              : json_real(value);
}

enum statistic { STATISTIC_MEAN, STATISTIC_DEVIATION };

static json_t *statistic_of(const struct counts *runs, int n_run, struct selection of,
                            enum statistic statistic)
{
    if (statistic == STATISTIC_DEVIATION && n_run < 2) return json_null();
    double *values = NEW_ARRAY(double, n_run);
    for (int r = 0; r < n_run; r++)
        values[r] = select_count(&runs[r], of);
    const double result = statistic == STATISTIC_MEAN
                              ? gsl_stats_mean(values, 1, (size_t)n_run)
                              : gsl_stats_sd(values, 1, (size_t)n_run);
    free(values);
    return number(result);
}

// {"normal":…, "shear":…, "total":…}
static json_t *by_mode(const struct counts *runs, int n_run, struct selection of,
                       enum statistic statistic)
{
    json_t *object = json_object();
    for (of.mode = 0; of.mode <= MODE_COUNT; of.mode++)
        json_object_set_new(object, modes[of.mode],
                            statistic_of(runs, n_run, of, statistic));
    return object;
}

static struct selection whole(void)
{
    return (struct selection){PERIOD_COUNT, -1, MODE_COUNT};
}

// {"cracks":{by mode}, "first":{by mode}, "second":{by mode}}
static json_t *table(const struct counts *runs, int n_run, enum statistic statistic)
{
    json_t *object = json_object();
    json_object_set_new(object, "cracks", by_mode(runs, n_run, whole(), statistic));
    for (int period = 0; period < PERIOD_COUNT; period++)
        json_object_set_new(object, periods[period],
                            by_mode(runs, n_run,
                                    (struct selection){period, -1, MODE_COUNT},
                                    statistic));
    return object;
}

static json_t *period_list(const struct counts *runs, int n_run)
{
    json_t *list = json_array();
    for (int period = 0; period < PERIOD_COUNT; period++) {
        json_t *entry = by_mode(runs, n_run, (struct selection){period, -1, MODE_COUNT},
                                STATISTIC_MEAN);
        json_object_set_new(entry, "name", json_string(periods[period]));
        json_array_append_new(list, entry);
    }
    return list;
}

static json_t *profile(const struct counts *runs, int n_run, int n_slice)
{
    json_t *list = json_array();
    for (int slice = 0; slice < n_slice; slice++) {
        json_t *entry =
            by_mode(runs, n_run, (struct selection){PERIOD_COUNT, slice, MODE_COUNT},
                    STATISTIC_MEAN);
        json_object_set_new(entry, "from", json_real((double)slice / n_slice));
        json_object_set_new(entry, "to", json_real((slice + 1.0) / n_slice));
        json_array_append_new(list, entry);
    }
    return list;
}

void summarise(json_t *report, const struct counts *runs, int n_run, int n_slice)
{
    json_object_set_new(report, "cracks",
                        by_mode(runs, n_run, whole(), STATISTIC_MEAN));
    json_object_set_new(report, "periods", period_list(runs, n_run));
    json_object_set_new(report, "profile", profile(runs, n_run, n_slice));
    json_object_set_new(report, "mean", table(runs, n_run, STATISTIC_MEAN));
    json_object_set_new(report, "sd",
                        n_run < 2 ? json_null()
                                  : table(runs, n_run, STATISTIC_DEVIATION));
    json_t *each = json_array();
    for (int r = 0; r < n_run; r++)
        json_array_append_new(each, table(&runs[r], 1, STATISTIC_MEAN));
    json_object_set_new(report, "each", each);
}
