// SPDX-License-Identifier: GPL-3.0-or-later
// The statistics as JSON. mean, sd, confidence_interval, each and test are tables of
// the same shape, {group: {name: ...}} by statistic_names: `table` goes through the
// statistics once and asks a function for the value of each, from the runs that a
// struct column selects:
//     mean, sd, confidence_interval   all runs; the last two null for one run
//     each                            one run a table, so that the mean is its value
//     test                            the runs from `first` on, and those before them
// A statistic that some run does not have (NAN) is null in mean, sd and test, and a
// pair of nulls in confidence_interval: no run is left out silently. Statistics of
// patterns, which are the last ones, are there only where patterns are.
//
// test has Welch's and Mann and Whitney's tests, and for paired groups also Student's
// paired one and Wilcoxon's (statistics/). Student's intervals take the runs for
// independent: seeds must differ.
#include "basics/memory.h"
#include "report.h"
#include "statistics/paired.h"
#include "statistics/sample.h"

#include <math.h>
#include <stdlib.h>

// Some of the runs, of which one statistic is taken.
struct column {
    const struct ensemble *ensemble;
    int first, n;
    double confidence;
    bool paired; // with the runs before the first
};

// The caller frees the values.
static struct sample take(struct column column, enum statistic fact)
{
    double *value = NEW_ARRAY(double, column.n);
    for (int r = 0; r < column.n; r++)
        value[r] = column.ensemble->statistics[column.first + r].value[fact];
    return (struct sample){value, column.n};
}

static json_t *mean_of(struct column column, enum statistic fact)
{
    const struct sample sample = take(column, fact);
    json_t *mean = json_value(sample_mean(sample));
    free((void *)sample.value);
    return mean;
}

static json_t *deviation_of(struct column column, enum statistic fact)
{
    const struct sample sample = take(column, fact);
    json_t *deviation = json_value(sample_deviation(sample));
    free((void *)sample.value);
    return deviation;
}

// Called for two runs or more: with one half_width is NAN.
static json_t *interval_of(struct column column, enum statistic fact)
{
    const struct sample sample = take(column, fact);
    const double mean = sample_mean(sample);
    const double half = half_width(sample, column.confidence);
    free((void *)sample.value);
    return json_pack("[o,o]", json_value(mean - half), json_value(mean + half));
}

// {"cracks":{"normal":…, …}, …}, with what OF gives for each fact.
static json_t *table(struct column column, json_t *of(struct column, enum statistic))
{
    json_t *object = json_object();
    const int count = column.ensemble->pattern ? STATISTIC_COUNT : POLYGONS_FOUND;
    for (int f = 0; f < count; f++) {
        json_t *group = json_object_get(object, statistic_names[f].group);
        if (!group) {
            group = json_object();
            json_object_set_new(object, statistic_names[f].group, group);
        }
        json_object_set_new(group, statistic_names[f].name,
                            of(column, (enum statistic)f));
    }
    return object;
}

// Adds the tests of the differences to TEST; A and B have as many values.
static void test_pairs(json_t *test, struct sample a, struct sample b)
{
    const struct paired_t t = paired_t_test(a, b);
    const struct wilcoxon rank = wilcoxon_test(a, b);
    json_object_set_new(test, "paired_t",
                        json_pack("{s:o,s:o,s:o,s:o,s:o}", "mean", json_value(t.mean),
                                  "sd", json_value(t.sd), "t", json_value(t.t),
                                  "degrees_of_freedom", json_value(t.degrees), "p",
                                  json_value(t.p)));
    json_object_set_new(test, "wilcoxon",
                        json_pack("{s:o,s:o,s:b}", "v", json_value(rank.v), "p",
                                  json_value(rank.p), "exact", rank.exact));
}

// Null if a run of either group does not have the statistic.
static json_t *test_samples(struct sample a, struct sample b)
{
    if (isnan(sample_mean(a)) || isnan(sample_mean(b))) return json_null();
    const struct welch welch = welch_test(a, b);
    const struct mann_whitney rank = mann_whitney_test(a, b);
    return json_pack("{s:[o,o],s:[o,o],s:{s:o,s:o,s:o},s:{s:o,s:o,s:b}}", "mean",
                     json_value(sample_mean(a)), json_value(sample_mean(b)), "sd",
                     json_value(sample_deviation(a)), json_value(sample_deviation(b)),
                     "welch", "t", json_value(welch.t), "degrees_of_freedom",
                     json_value(welch.degrees), "p", json_value(welch.p),
                     "mann_whitney", "u", json_value(rank.u), "p", json_value(rank.p),
                     "exact", rank.exact);
}

// Tests the runs before COLUMN's first against COLUMN's own.
static json_t *test_of(struct column column, enum statistic fact)
{
    const struct sample a =
        take((struct column){.ensemble = column.ensemble, .n = column.first}, fact);
    const struct sample b = take(column, fact);
    json_t *test = test_samples(a, b);
    if (column.paired && json_is_object(test)) test_pairs(test, a, b);
    free((void *)a.value);
    free((void *)b.value);
    return test;
}

static json_t *test(const struct ensemble *ensemble, struct groups groups)
{
    if (groups.first == 0) return json_null();
    const struct column second = {.ensemble = ensemble,
                                  .first = groups.first,
                                  .n = ensemble->n_run - groups.first,
                                  .paired = groups.paired};
    json_t *test = table(second, test_of);
    json_object_set_new(test, "groups", json_pack("[i,i]", groups.first, second.n));
    return test;
}

// A reader of a lone interval must see what it is of.
static json_t *what_intervals_are(int runs, double confidence)
{
    if (runs == 1) return json_string("one run: no interval; repeat over seeds");
    return json_sprintf("%g %% confidence interval of the mean over %d runs, by "
                        "Student's t",
                        100 * confidence, runs);
}

void report_statistics(json_t *report, const struct ensemble *ensemble,
                       double confidence, struct groups groups)
{
    const struct column all = {ensemble, 0, ensemble->n_run, confidence, false};
    const bool many = ensemble->n_run > 1;
    json_object_set_new(report, "interval_of",
                        what_intervals_are(ensemble->n_run, confidence));
    json_object_set_new(report, "mean", table(all, mean_of));
    json_object_set_new(report, "sd", many ? table(all, deviation_of) : json_null());
    json_object_set_new(report, "confidence_interval",
                        many ? table(all, interval_of) : json_null());
    json_object_set_new(report, "test", test(ensemble, groups));
    json_t *each = json_array();
    for (int r = 0; r < ensemble->n_run; r++)
        json_array_append_new(
            each, table((struct column){ensemble, r, 1, 0, false}, mean_of));
    json_object_set_new(report, "each", each);
}
