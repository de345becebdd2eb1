// SPDX-License-Identifier: GPL-3.0-or-later
// The slider of the page has rows, chosen from many steps of a run: a row where
//
//     gone = (t - t_0) / (t_end - t_0) - saturation
//
// has risen by 2 / (most - 2) since the last row. Over the run `gone` rises by 1 from
// time and by up to 1 from saturation, so that there are at most MOST rows. Rows even
// in time would miss a fast end, rows even in saturation a long tail.
//
// A moment between rows is a key, key = round(row keys_a_row), with row a whole number
// and a fraction; 65535 is kept for never, and keys of all rows fit into 16 bits.
#include "course.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The steps that rows are chosen from.
struct steps {
    int count;
    const double *time, *saturation; // (count)
};

// Rows (at most MOST) of STEPS: one wherever time and saturation together, as shares of
// the whole, have gone on by as much as even rows would. The last step is a row. The
// first and the last step are rows always; up to MOST steps all are.
static int *choose_rows(const struct steps *steps, int most, int *count)
{
    int *row = NEW_ARRAY(int, most + 1);
    *count = 0;
    if (!steps->count) return row;
    const int last = steps->count - 1;
    const double begin = steps->time[0], span = steps->time[last] - begin;
    const double change = 2.0 / (most - 2 > 1 ? most - 2 : 1);
    double since = INFINITY;
    for (int k = 0; k <= last; k++) {
        const double gone =
            (span > 0 ? (steps->time[k] - begin) / span : 0) - steps->saturation[k];
        if (k > 0 && k < last && steps->count > most && gone - since < change) continue;
        row[(*count)++] = k;
        since = gone;
    }
    return row;
}

static double *at_rows(const double *value, const int *row, int count)
{
    double *chosen = NEW_ARRAY(double, count);
    for (int k = 0; k < count; k++)
        chosen[k] = value[row[k]];
    return chosen;
}

static void get_history(struct course *course, const struct artifact *drying,
                        const int *row)
{
    double *rate = artifact_get(drying, "/history/rate", NULL);
    int32_t *clusters = artifact_get(drying, "/history/clusters", NULL);
    course->rate = at_rows(rate, row, course->n_row);
    course->clusters = NEW_ARRAY(double, course->n_row);
    for (int k = 0; k < course->n_row; k++)
        course->clusters[k] = clusters[row[k]];
    free(rate);
    free(clusters);
}

// A motion has no saturation: rows are even in time then. A flow has no course, and the
// page no slider.
struct course course_of(const struct run *run, int most)
{
    struct course course = {0};
    double *time = NULL, *saturation = NULL;
    struct steps steps = {run->record.n_step, run->record.time, run->record.saturation};
    if (run->flow) return course;
    const bool is_replay = !steps.count && run->of[RESPONSE];
    if (run->motion) {
        time = artifact_get(run->motion, "/history/time", &steps.count);
        saturation = NEW_ARRAY(double, steps.count);
        steps = (struct steps){steps.count, time, saturation};
    } else if (is_replay) {
        time = artifact_get(run->of[RESPONSE], "/history/time", &steps.count);
        saturation = artifact_get(run->of[RESPONSE], "/history/saturation", NULL);
        steps = (struct steps){steps.count, time, saturation};
    } else if (!steps.count) {
        steps = (struct steps){run->n_load, run->load_time, run->load_saturation};
    }
    int *row = choose_rows(&steps, most, &course.n_row);
    course.time = at_rows(steps.time, row, course.n_row);
    course.saturation = at_rows(steps.saturation, row, course.n_row);
    course.keys_a_row = (NEVER - 1) / (course.n_row > 1 ? course.n_row - 1 : 1);
    if (run->record.n_step) get_history(&course, run->of[DRYING], row);
    course.row = row;
    free(time);
    free(saturation);
    return course;
}

void course_free(struct course *course)
{
    free(course->row);
    free(course->time);
    free(course->saturation);
    free(course->rate);
    free(course->clusters);
    *course = (struct course){0};
}

// The row at TIME, with the fraction of the way to the next. Bisection: rows may be far
// from even in time. Times outside of the course get its ends.
static double row_at(const struct course *course, double time)
{
    const int last = course->n_row - 1;
    if (last < 1 || time <= course->time[0]) return 0;
    if (time >= course->time[last]) return last;
    int low = 0, high = last; // time[low] <= time < time[high]
    while (high - low > 1) {
        const int middle = low + (high - low) / 2;
        if (course->time[middle] <= time)
            low = middle;
        else
            high = middle;
    }
    return low + (time - course->time[low]) / (course->time[high] - course->time[low]);
}

uint32_t key_of(const struct course *course, double time)
{
    return (uint32_t)lround(row_at(course, time) * course->keys_a_row);
}

double saturation_at(const struct course *course, double time)
{
    if (!course->n_row) return NAN;
    const double row = row_at(course, time);
    const int low = (int)row, high = low + (low + 1 < course->n_row);
    return course->saturation[low] +
           (row - low) * (course->saturation[high] - course->saturation[low]);
}

// Numbers up to each row, by mode; the last row counts what is left, which rounding may
// put behind its time.
static void put_cracks(struct arrays *arrays, const struct course *course,
                       const struct run *run)
{
    uint32_t *count[2] = {NEW_ARRAY(uint32_t, course->n_row),
                          NEW_ARRAY(uint32_t, course->n_row)};
    uint32_t so_far[2] = {0, 0};
    for (int row = 0, k = 0; row < course->n_row; row++) {
        const bool is_last = row == course->n_row - 1;
        for (; k < run->n_crack && (run->crack_time[k] <= course->time[row] || is_last);
             k++)
            so_far[run->crack_mode[k]]++;
        count[0][row] = so_far[0];
        count[1][row] = so_far[1];
    }
    arrays_put(arrays, "course.tension", count[0], (size_t)course->n_row, true);
    arrays_put(arrays, "course.shear", count[1], (size_t)course->n_row, true);
    free(count[0]);
    free(count[1]);
}

void put_course(struct arrays *arrays, const struct course *course,
                const struct run *run)
{
    const size_t n = (size_t)course->n_row;
    if (!n) return;
    arrays_put_doubles(arrays, "course.time", course->time, n);
    if (!run->motion)
        arrays_put_doubles(arrays, "course.saturation", course->saturation, n);
    if (course->rate) arrays_put_doubles(arrays, "course.rate", course->rate, n);
    if (course->clusters)
        arrays_put_doubles(arrays, "course.clusters", course->clusters, n);
    if (run->of[RESPONSE] || run->n_crack) put_cracks(arrays, course, run);
}
