// SPDX-License-Identifier: GPL-3.0-or-later
// The tables as JSON: sums over the runs, divided by their number. The entry of a
// class, {"normal", "shear", "total", "from", "to"}, is made by `by_mode` and
// `classes`; `put_scatter` adds `sd` and `confidence_interval` afterwards and takes the
// mean from the entry:
//     sum = round(2 mean runs) / 2,   counts being multiples of 1/2,
// is the exact sum again, so sums need not be handed on. Trap: that holds only for
// counts; other values must not go this way.
//
//     sd = sqrt((n sum of squares - sum^2) / (n (n - 1)))          (scatter.h)
//     confidence_interval = mean -+ half_width_of(sd)      (statistics/sample.h)
// Borders of classes are (start (n - k) + end k) / n: exact at both ends. What is not
// finite is null (json_value), as JSON has no other word for it.
#include "basics/memory.h"
#include "basics/sorted.h"
#include "report.h"
#include "statistics/sample.h"

#include <math.h>
#include <stdlib.h>

// null where a statistic has no value; whole numbers without a point, so that counts
// look like counts.
json_t *json_value(double value)
{
    if (!isfinite(value)) return json_null();
    return fabs(value) < 1e15 && value == (double)(json_int_t)value
               ? json_integer((json_int_t)value)
               : json_real(value);
}

// The total is the mean of the sum, rounded once, not the sum of two rounded means.
static json_t *by_mode(const double of[MODE_COUNT], double runs)
{
    return json_pack("{s:o,s:o,s:o}", "normal", json_value(of[MODE_NORMAL] / runs),
                     "shear", json_value(of[MODE_SHEAR] / runs), "total",
                     json_value((of[MODE_NORMAL] + of[MODE_SHEAR]) / runs));
}

// ---- counts -------------------------------------------------------------------------

static json_t *periods(const struct counts *counts, double runs)
{
    static const char *const names[PERIOD_COUNT] = {"first", "second"};
    json_t *list = json_array();
    for (int period = 0; period < PERIOD_COUNT; period++) {
        json_t *entry = by_mode(counts->period[period], runs);
        json_object_set_new(entry, "name", json_string(names[period]));
        json_array_append_new(list, entry);
    }
    return list;
}

// Classes of equal width, from START to END. Borders are interpolated from both ends,
// so that the last one is exactly END.
static json_t *classes(const double (*of)[MODE_COUNT], int n, double start, double end,
                       double runs)
{
    json_t *list = json_array();
    for (int k = 0; k < n; k++) {
        json_t *entry = by_mode(of[k], runs);
        json_object_set_new(entry, "from", json_real((start * (n - k) + end * k) / n));
        json_object_set_new(entry, "to",
                            json_real((start * (n - k - 1) + end * (k + 1)) / n));
        json_array_append_new(list, entry);
    }
    return list;
}

// Puts into ENTRY how the counts of a class, RUNS times their mean, scatter. One run
// has no deviation and no interval: null.
static void put_scatter(json_t *entry, const double squares[COLUMN_COUNT], int runs,
                        double confidence)
{
    static const char *const names[COLUMN_COUNT] = {"normal", "shear", "total"};
    json_t *sd = runs > 1 ? json_object() : json_null();
    json_t *interval = runs > 1 ? json_object() : json_null();
    for (int c = 0; c < COLUMN_COUNT && runs > 1; c++) {
        const double mean = json_number_value(json_object_get(entry, names[c]));
        const double deviation =
            counts_deviation(round(2 * mean * runs) / 2, squares[c], runs); // of halves
        const double half = half_width_of(deviation, runs, confidence);
        json_object_set_new(sd, names[c], json_value(deviation));
        json_object_set_new(
            interval, names[c],
            json_pack("[o,o]", json_value(mean - half), json_value(mean + half)));
    }
    json_object_set_new(entry, "sd", sd);
    json_object_set_new(entry, "confidence_interval", interval);
}

// Classes that are counted run by run.
static json_t *scattered(json_t *list, const double (*squares)[COLUMN_COUNT], int runs,
                         double confidence)
{
    size_t k;
    json_t *entry;
    json_array_foreach(list, k, entry) put_scatter(entry, squares[k], runs, confidence);
    return list;
}

// At the end of each interval of saturation: cracks so far in every slice, and the
// saturation of the slices. In the order of drying: the first interval is the wettest.
// The liquid is known only if each run had its drying.
static json_t *profiles(const struct ensemble *ensemble)
{
    const int n_slice = ensemble->classes.n_slice, n = ensemble->classes.n_interval;
    const bool known = ensemble->n_liquid == ensemble->n_run;
    double *so_far = NEW_ARRAY(double, n_slice);
    json_t *list = json_array();
    for (int k = 0; k < n; k++) {
        json_t *cracks = json_array(), *liquid = json_array();
        for (int s = 0; s < n_slice; s++) {
            const size_t at = (size_t)k * (size_t)n_slice + (size_t)s;
            so_far[s] += ensemble->counts.place[at];
            json_array_append_new(cracks, json_value(so_far[s] / ensemble->n_run));
            json_array_append_new(
                liquid, json_value(ensemble->front.slice[at] / ensemble->n_run));
        }
        json_array_append_new(list, json_pack("{s:f,s:o,s:o}", "saturation",
                                              (n - k - 1.0) / n, "cracks", cracks,
                                              "liquid", known ? liquid : json_null()));
        if (!known) json_decref(liquid);
    }
    free(so_far);
    return list;
}

// ---- sizes --------------------------------------------------------------------------

// [{"size":…, "count":…}, …], rising sizes, those that occur. Sorts them.
static json_t *size_distribution(struct sizes sizes, double runs)
{
    json_t *list = json_array();
    if (sizes.count)
        qsort(sizes.size, (size_t)sizes.count, sizeof *sizes.size, rising_ints);
    for (int first = 0, end; first < sizes.count; first = end) {
        for (end = first; end < sizes.count && sizes.size[end] == sizes.size[first];)
            end++;
        json_array_append_new(list,
                              json_pack("{s:i,s:o}", "size", sizes.size[first], "count",
                                        json_value((end - first) / runs)));
    }
    return list;
}

// ---- orientation --------------------------------------------------------------------

// Sum of n n over its trace: its trace is 1, and a third in each direction where cracks
// have none.
static json_t *fabric(const double sum[9])
{
    const double trace = sum[0] + sum[4] + sum[8];
    if (!(trace > 0)) return json_null();
    json_t *rows = json_array();
    for (const double *row = sum; row < sum + 9; row += 3)
        json_array_append_new(
            rows, json_pack("[f,f,f]", row[0] / trace, row[1] / trace, row[2] / trace));
    return rows;
}

static json_t *orientation(const struct ensemble *ensemble, double confidence)
{
    const struct orientation *of = &ensemble->orientation;
    const double runs = ensemble->n_run;
    json_t *list =
        scattered(classes(of->cracks, INCLINATION_CLASSES, 0, 90, runs),
                  ensemble->squares.inclination, ensemble->n_run, confidence);
    size_t k;
    json_t *entry;
    json_array_foreach(list, k, entry)
        json_object_set_new(entry, "bonds", json_value(of->bonds[k] / runs));
    double both[9];
    for (int c = 0; c < 9; c++)
        both[c] = of->fabric[MODE_NORMAL][c] + of->fabric[MODE_SHEAR][c];
    return json_pack("{s:o,s:{s:o,s:o,s:o}}", "inclination", list, "fabric", "normal",
                     fabric(of->fabric[MODE_NORMAL]), "shear",
                     fabric(of->fabric[MODE_SHEAR]), "total", fabric(both));
}

// ---- deformation, front -------------------------------------------------------------

// Means over the runs at each snapshot; a run without a value leaves none.
static json_t *deformation(const struct ensemble *ensemble)
{
    static const char *const names[STRAIN_COUNT] = {"xx", "yy", "zz", "yz", "xz", "xy"};
    const double runs = ensemble->n_run;
    json_t *list = json_array();
    for (int s = 0; s < ensemble->n_snapshot; s++) {
        const struct deformation *sum = &ensemble->deformation[s];
        json_t *strain = json_object();
        for (int k = 0; k < STRAIN_COUNT; k++)
            json_object_set_new(strain, names[k], json_value(sum->strain[k] / runs));
        json_array_append_new(
            list, json_pack("{s:f,s:o,s:o}", "saturation",
                            ensemble->snapshot_saturation[s] / runs, "shrinkage",
                            json_value(sum->shrinkage / runs), "strain", strain));
    }
    return list;
}

// Null unless each run had its drying: means over some of the runs would not fit the
// other tables.
static json_t *front(const struct ensemble *ensemble)
{
    if (ensemble->n_liquid < ensemble->n_run) return json_null();
    const double runs = ensemble->n_run;
    json_t *local = json_array();
    for (int k = 0; k < LOCAL_CLASSES; k++)
        json_array_append_new(
            local, json_pack("{s:f,s:f,s:o}", "from",
                             (double)(LOCAL_CLASSES - k) / LOCAL_CLASSES, "to",
                             (LOCAL_CLASSES - k - 1.0) / LOCAL_CLASSES, "cracks",
                             json_value(ensemble->front.local[k] / runs)));
    const double correlation =
        front_correlation(ensemble->front.first, ensemble->front.slice,
                          ensemble->counts.place, ensemble->classes);
    return json_pack("{s:o,s:o}", "correlation", json_value(correlation),
                     "slice_saturation", local);
}

// In the order of schemas/crackstats.json.
void report_tables(json_t *report, const struct ensemble *ensemble, double confidence)
{
    const struct counts *counts = &ensemble->counts;
    const struct squares *squares = &ensemble->squares;
    const double runs = ensemble->n_run;
    const int n_slice = ensemble->classes.n_slice, n = ensemble->classes.n_interval;
    double all[MODE_COUNT];
    count_all(all, counts);
    json_t *cracks = by_mode(all, runs);
    put_scatter(cracks, squares->all[0], ensemble->n_run, confidence);
    json_object_set_new(report, "cracks", cracks);
    json_object_set_new(
        report, "periods",
        scattered(periods(counts, runs), squares->period, ensemble->n_run, confidence));
    json_object_set_new(report, "profile",
                        scattered(classes(counts->slice, n_slice, 0, 1, runs),
                                  squares->slice, ensemble->n_run, confidence));
    json_object_set_new(report, "by_saturation",
                        scattered(classes(counts->saturation, n, 1, 0, runs),
                                  squares->saturation, ensemble->n_run, confidence));
    json_object_set_new(report, "by_time",
                        scattered(classes(counts->time, n, 0, 1, runs), squares->time,
                                  ensemble->n_run, confidence));
    json_object_set_new(report, "profiles", profiles(ensemble));
    json_object_set_new(report, "clusters",
                        size_distribution(ensemble->clusters, runs));
    json_object_set_new(report, "fragments",
                        size_distribution(ensemble->fragments, runs));
    json_object_set_new(report, "orientation", orientation(ensemble, confidence));
    json_object_set_new(report, "deformation", deformation(ensemble));
    json_object_set_new(report, "front", front(ensemble));
}
