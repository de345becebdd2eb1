// SPDX-License-Identifier: GPL-3.0-or-later
// For each fitted number: that of each run with its two errors, and the mean over the
// runs with half its interval. What a run does not have is 0 in the tables of the runs,
// where /levels/fitted and /rheology/points say so, and left out of the means.
//
// The two errors of a run answer two questions: the fit's, how well the curve is known
// if its points scatter independently; the blocks', how much the result changes from
// one part of the run to the next. The interval over the runs needs neither.
#include "basics/memory.h"
#include "over_runs.h"
#include "write_shearstats.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// NAN is for inside: artifacts hold finite numbers only.
static double or_zero(double value)
{
    return isnan(value) ? 0 : value;
}

// ---- levels -------------------------------------------------------------------------

struct level_number {
    double value, fit_error, block_error;
};

static struct level_number number_of(const struct run_result *run, int level,
                                     bool width)
{
    const struct band_fit *fit = &run->level[level];
    if (!fit->converged) return (struct level_number){NAN, NAN, NAN};
    return width ? (struct level_number){fit->width, fit->width_error,
                                         run->width_block_error[level]}
                 : (struct level_number){fit->centre, fit->centre_error,
                                         run->centre_block_error[level]};
}

// Centre or width: tables of the runs, (n_run, n_level), and means, (n_level).
static void put_level_number(struct artifact *artifact, const struct study *study,
                             bool width, double confidence)
{
    const int n = study->cell.n_level, n_run = study->n_run;
    const char *what = width ? "width" : "centre";
    double *table = NEW_ARRAY(double, 3 * n_run * n), *mean = NEW_ARRAY(double, 2 * n);
    double *value = NEW_ARRAY(double, n_run);
    for (int level = 0; level < n; level++) {
        for (int r = 0; r < n_run; r++) {
            const struct level_number of = number_of(&study->run[r], level, width);
            value[r] = of.value;
            table[r * n + level] = or_zero(of.value);
            table[(n_run + r) * n + level] = or_zero(of.fit_error);
            table[(2 * n_run + r) * n + level] = or_zero(of.block_error);
        }
        const struct over_runs over = over_runs(value, n_run, confidence);
        mean[level] = over.mean;
        mean[n + level] = over.half_width;
    }
    const char *const parts[] = {"run_%s", "run_%s_fit_error", "run_%s_block_error"};
    char part[64], name[80];
    for (int k = 0; k < 3; k++) {
        snprintf(part, sizeof part, parts[k], what);
        snprintf(name, sizeof name, "/levels/%s", part);
        artifact_put_table(artifact, name, table + (size_t)k * (size_t)(n_run * n),
                           n_run, n);
    }
    snprintf(name, sizeof name, "/levels/%s", what);
    artifact_put(artifact, name, mean, n);
    snprintf(name, sizeof name, "/levels/%s_half_width", what);
    artifact_put(artifact, name, mean + n, n);
    free(table);
    free(mean);
    free(value);
}

// The mean of a ring over the runs that have enough solid there.
static void put_profiles(struct artifact *artifact, const struct study *study,
                         double confidence)
{
    const int n = study->cell.n_level, n_r = study->grid.axis[0].n;
    double *radius = NEW_ARRAY(double, n_r), *mean = NEW_ARRAY(double, n *n_r);
    double *error = NEW_ARRAY(double, n *n_r), *value = NEW_ARRAY(double, study->n_run);
    int32_t *runs = NEW_ARRAY(int32_t, n * n_r);
    for (int k = 0; k < n_r; k++)
        radius[k] = cell_centre(&study->grid, k * study->grid.axis[2].n, 0);
    for (int k = 0; k < n * n_r; k++) {
        for (int r = 0; r < study->n_run; r++)
            value[r] = study->run[r].turned_counts[k] ? study->run[r].turned[k] : NAN;
        const struct over_runs over = over_runs(value, study->n_run, confidence);
        mean[k] = over.mean;
        error[k] = over.standard_error;
        runs[k] = over.n;
    }
    artifact_put(artifact, "/profiles/radius", radius, n_r);
    artifact_put_table(artifact, "/profiles/turned", mean, n, n_r);
    artifact_put_table(artifact, "/profiles/standard_error", error, n, n_r);
    artifact_put_table(artifact, "/profiles/runs", runs, n, n_r);
    void *const owned[] = {radius, mean, error, value, runs};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
}

static void put_levels(struct artifact *artifact, const struct study *study,
                       double confidence)
{
    const int n = study->cell.n_level;
    uint8_t *fitted = NEW_ARRAY(uint8_t, study->n_run * n);
    double *residual = NEW_ARRAY(double, study->n_run *n);
    for (int k = 0; k < study->n_run * n; k++) {
        const struct band_fit *fit = &study->run[k / n].level[k % n];
        fitted[k] = fit->converged;
        residual[k] = fit->converged ? fit->residual : 0;
    }
    artifact_put(artifact, "/levels/height", study->cell.height, n);
    artifact_put_table(artifact, "/levels/fitted", fitted, study->n_run, n);
    artifact_put_table(artifact, "/levels/run_residual", residual, study->n_run, n);
    put_level_number(artifact, study, false, confidence);
    put_level_number(artifact, study, true, confidence);
    put_profiles(artifact, study, confidence);
    free(fitted);
    free(residual);
}

// ---- one number a run ---------------------------------------------------------------

enum run_number { NUMBER_FRICTION, NUMBER_COHESION, NUMBER_TORQUE };

// A torque has no fit, so no error of one.
static double run_number(const struct run_result *run, enum run_number which, int part)
{
    const struct line_fit *line = &run->line;
    const struct torque *torque = &run->torque;
    const double of[3][3] = {
        {line->friction, line->friction_error, run->friction_block_error},
        {line->cohesion, line->cohesion_error, run->cohesion_block_error},
        {torque->mean, NAN, torque->block_error}};
    const bool known = which == NUMBER_TORQUE ? torque->rows > 0 : line->n >= 3;
    return known ? of[which][part] : NAN;
}

// DATASETS: its value, and its fit and block errors (NULL: none), in each run; SUMMARY:
// the attribute with the mean. or_zero hides which runs have none, so the mean takes
// the numbers anew.
static void put_run_number(struct artifact *artifact, const struct study *study,
                           enum run_number which, const char *const datasets[3],
                           const char *summary, double confidence)
{
    const int n = study->n_run;
    double *value = NEW_ARRAY(double, n);
    for (int part = 2; part >= 0; part--) {
        if (!datasets[part]) continue;
        for (int r = 0; r < n; r++)
            value[r] = or_zero(run_number(&study->run[r], which, part));
        artifact_put(artifact, datasets[part], value, n);
    }
    for (int r = 0; r < n; r++)
        value[r] = run_number(&study->run[r], which, 0);
    const struct over_runs over = over_runs(value, n, confidence);
    free(value);
    if (over.n == 0) return;
    char name[64];
    snprintf(name, sizeof name, "/summary/%s", summary);
    artifact_put_number(artifact, name, over.mean);
    snprintf(name, sizeof name, "/summary/%s_half_width", summary);
    if (over.n > 1) artifact_put_number(artifact, name, over.half_width);
}

static void put_rheology(struct artifact *artifact, const struct study *study,
                         double confidence)
{
    static const char *const friction[3] = {"/rheology/run_friction",
                                            "/rheology/run_friction_fit_error",
                                            "/rheology/run_friction_block_error"};
    static const char *const cohesion[3] = {"/rheology/run_cohesion",
                                            "/rheology/run_cohesion_fit_error",
                                            "/rheology/run_cohesion_block_error"};
    int64_t *points = NEW_ARRAY(int64_t, study->n_run);
    for (int r = 0; r < study->n_run; r++)
        points[r] = study->run[r].line.n;
    artifact_put(artifact, "/rheology/run_points", points, study->n_run);
    free(points);
    put_run_number(artifact, study, NUMBER_FRICTION, friction, "friction", confidence);
    put_run_number(artifact, study, NUMBER_COHESION, cohesion, "cohesion", confidence);
}

// ---- separations --------------------------------------------------------------------

// Classes that any run has: the first and how many. Runs begin and end at different
// separations; classes have one width, so they match.
static int common_classes(const struct study *study, int64_t *lowest)
{
    int64_t first = INT64_MAX, past = INT64_MIN;
    for (int r = 0; r < study->n_run; r++) {
        const struct separations *of = &study->run[r].separations;
        if (of->n == 0) continue;
        first = of->lowest < first ? of->lowest : first;
        past = of->lowest + of->n > past ? of->lowest + of->n : past;
    }
    *lowest = past > first ? first : 0;
    return past > first ? (int)(past - first) : 0;
}

// Count per snapshot in class K (global number) of ZONE; the sum of forces in FORCE.
// Per snapshot, so that runs of different length count alike.
static double count_in(const struct run_result *run, int64_t k, int zone, double *force)
{
    const struct separations *of = &run->separations;
    *force = 0;
    if (of->n == 0 || k < of->lowest || k >= of->lowest + of->n) return 0;
    *force = of->class[k - of->lowest].force[zone] / run->snapshots;
    return of->class[k - of->lowest].count[zone] / run->snapshots;
}

// The force is the mean of the sums over the mean of the counts, [G 15] with all pairs
// of all runs: a mean of the runs' means would give a run with few pairs too much
// weight.
static void put_separations(struct artifact *artifact, const struct study *study,
                            double confidence)
{
    int64_t lowest;
    const int n = common_classes(study, &lowest), n_run = study->n_run;
    double *from = NEW_ARRAY(double, n), *count = NEW_ARRAY(double, n *ZONES);
    double *error = NEW_ARRAY(double, n *ZONES), *force = NEW_ARRAY(double, n *ZONES);
    double *value = NEW_ARRAY(double, n_run);
    for (int k = 0; k < n * ZONES; k++) {
        double forces = 0, of;
        const int64_t class = lowest + k / ZONES;
        from[k / ZONES] = (double)class * study->class_width;
        for (int r = 0; r < n_run; r++) {
            value[r] = count_in(&study->run[r], class, k % ZONES, &of);
            forces += of / n_run;
        }
        const struct over_runs over = over_runs(value, n_run, confidence);
        count[k] = over.mean;
        error[k] = over.standard_error;
        force[k] = over.mean > 0 ? forces / over.mean : 0;
    }
    double volume[ZONES] = {0};
    for (int r = 0; r < n_run; r++)
        for (int zone = 0; zone < ZONES; zone++)
            volume[zone] += study->run[r].zone_volume[zone] / n_run;
    artifact_put(artifact, "/separations/from", from, n);
    artifact_put(artifact, "/separations/count", count, n);
    artifact_put(artifact, "/separations/count_standard_error", error, n);
    artifact_put(artifact, "/separations/force", force, n);
    artifact_put(artifact, "/separations/volume", volume, ZONES);
    artifact_put_number(artifact, "/summary/separation_class", study->class_width);
    void *const owned[] = {from, count, error, force, value};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
}

void put_statistics(struct artifact *artifact, const struct study *study,
                    double confidence)
{
    static const char *const torque[3] = {"/torque/run", NULL,
                                          "/torque/run_block_error"};
    put_rheology(artifact, study, confidence);
    put_separations(artifact, study, confidence);
    if (study->cell.n_level > 0) put_levels(artifact, study, confidence);
    if (study->has_part)
        put_run_number(artifact, study, NUMBER_TORQUE, torque, "torque", confidence);
}
