// SPDX-License-Identifier: GPL-3.0-or-later
// Runs whose scenes are equal but for seeds are a group: draws of the same. Statistics
// are those of crackstats: the mean with its interval by Student's t, Welch's t test,
// and Mann and Whitney's U test, all two-sided.
//
// A scene is flattened to keys ("dry.liquid") and values. Keys whose values are not the
// same in all runs are `differing`. The name of a group is made of the differing keys
// that do not end in "seed" and their values, so equal names are equal scenes.
//
// Means are over the runs of a group that have a number: a run without cracks has no
// saturation at the first one. p-values are of each column by itself; with twelve
// columns one in twenty is below 0.05 by chance.
//
//     0     bonds                    of the packing
//     1-6   cracks of the response   all, by mode, %; saturation at first and half
//     7, 8  the course (course.h)    saturation at half the first rate; s until its end
//                                    (if times are not numbers of steps)
//     9-11  crackstats of the run    fragments: count, largest; shrinkage, %
//
// A number that a run does not have is NAN: it is left out of means, and a column that
// no run has is not shown.
#include "study.h"

#include "basics/memory.h"
#include "basics/status.h"
#include "facts.h"
#include "folders.h"
#include "html.h"
#include "provenance.h"
#include "statistics/sample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const column_name[] = {"bonds",
                                          "broken",
                                          "in tension",
                                          "in shear",
                                          "broken, %",
                                          "saturation at the first break",
                                          "saturation at half the breaks",
                                          "saturation at half the rate",
                                          "dried after, s",
                                          "pieces",
                                          "largest piece, grains",
                                          "shrinkage, %"};
enum { COLUMNS = sizeof column_name / sizeof *column_name, MOST_SHOWN = 12 };
static const double confidence = 0.95;

struct row {
    char *name, *link; // LINK: to its page; NULL where it has none
    json_t *scene;     // "dry.liquid": value, ...
    double value[COLUMNS];
    int group;
};

struct study {
    int n, n_group;
    struct row *row;     // (n)
    json_t *differing;   // ["dry.liquid", ...] what the scenes differ in
    json_t *group_names; // one a group
};

// ---- reading ------------------------------------------------------------------------

// Lists count as values: they differ or they do not.
static void flatten(json_t *flat, const char *prefix, json_t *value)
{
    if (!json_is_object(value)) {
        json_object_set(flat, prefix, value);
        return;
    }
    const char *key;
    json_t *member;
    json_object_foreach(value, key, member)
    {
        char *name = NULL;
        if (asprintf(&name, "%s%s%s", prefix, *prefix ? "." : "", key) < 0)
            die(STATUS_INTERNAL, "out of memory");
        flatten(flat, name, member);
        free(name);
    }
}

// Cracks are in the order of time, so row (n - 1) / 2 is when half of them had opened.
// Without cracks the saturations stay NAN.
static void read_cracks_of(double value[COLUMNS], const struct run *run)
{
    int count[2] = {0, 0};
    for (int k = 0; k < run->n_crack; k++)
        count[run->crack_mode[k]]++;
    const int n = run->n_crack, bonds = run->packing.n_bond;
    value[1] = n;
    value[2] = count[0];
    value[3] = count[1];
    value[4] = bonds ? 100.0 * n / bonds : NAN;
    if (!n) return;
    value[5] = run->crack_saturation[0];
    value[6] = run->crack_saturation[(n - 1) / 2];
}

// Columns in the order of column_name. The course has up to 20000 rows, so that the
// moment of half the rate is hardly blurred by their choice.
static void read_values(double value[COLUMNS], const struct run *run)
{
    for (int c = 0; c < COLUMNS; c++)
        value[c] = NAN;
    value[0] = run->packing.n_bond;
    if (run->of[RESPONSE]) read_cracks_of(value, run);
    const struct course course = course_of(run, 20000);
    const int half = row_of_half_rate(&course);
    if (half >= 0) value[7] = course.saturation[half];
    if (course.n_row && !counts_steps(run)) value[8] = course.time[course.n_row - 1];
    value[9] = counted_mean(run, "fragments", "count");
    value[10] = counted_mean(run, "fragments", "largest");
    value[11] = 100 * counted_mean(run, "shrinkage", "largest");
    struct course done = course;
    course_free(&done);
}

// One run in memory at a time.
static struct row row_of(const char *path, const char *output)
{
    struct run run = run_of_paths(&path, 1);
    struct row row = {.name = duplicate(path, strlen(path) + 1, 1),
                      .link = link_to(path, "report.html", output),
                      .scene = json_object()};
    if (run.flow || run.motion)
        die(STATUS_BAD_DATA, "%s: a study is of runs that dry", path);
    json_t *scene = scene_of(&run);
    flatten(row.scene, "", scene);
    json_decref(scene);
    read_values(row.value, &run);
    close_run(&run);
    return row;
}

// ---- what differs -------------------------------------------------------------------

// By the end of the key, as stages name them alike.
static bool is_seed(const char *key)
{
    const size_t n = strlen(key);
    return n >= 4 && !strcmp(key + n - 4, "seed");
}

// A key that one scene has and another has not differs, too.
static bool differs(const struct study *study, const char *key)
{
    for (int k = 1; k < study->n; k++) {
        const json_t *a = json_object_get(study->row[0].scene, key),
                     *b = json_object_get(study->row[k].scene, key);
        if ((a || b) && !(a && b && json_equal(a, b))) return true;
    }
    return false;
}

// Over all keys that any scene has. O(runs keys).
static void find_differences(struct study *study)
{
    json_t *all = json_object();
    for (int k = 0; k < study->n; k++)
        json_object_update(all, study->row[k].scene);
    study->differing = json_array();
    const char *key;
    json_t *value;
    json_object_foreach(all, key, value)
    {
        if (differs(study, key))
            json_array_append_new(study->differing, text_json(key));
    }
    json_decref(all);
}

// "dry.liquid": "inviscid" is "inviscid"; a number keeps nine digits.
static char *value_text(const json_t *value)
{
    const char *text = json_string_value(value);
    if (text) return duplicate(text, strlen(text) + 1, 1);
    if (json_is_real(value)) { // 100000, not 100000.0
        char number[40];
        const int length =
            snprintf(number, sizeof number, "%.9g", json_real_value(value));
        return duplicate(number, (size_t)length + 1, 1);
    }
    char *dumped = json_dumps(value ? value : json_null(),
                              JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(9));
    if (!dumped) die(STATUS_INTERNAL, "out of memory");
    return dumped;
}

// What a row has in the differing keys that are no seeds: "liquid inviscid, steps 40".
static char *group_name(const struct study *study, const struct row *row)
{
    char *name = NULL;
    size_t size, k;
    FILE *text = open_memstream(&name, &size);
    json_t *key;
    const char *before = "";
    json_array_foreach(study->differing, k, key)
    {
        const char *whole = json_string_value(key), *last = strrchr(whole, '.');
        if (is_seed(whole)) continue;
        char *value = value_text(json_object_get(row->scene, whole));
        fprintf(text, "%s%s %s", before, last ? last + 1 : whole, value);
        before = ", ";
        free(value);
    }
    fclose(text);
    return name;
}

// The line at TEXT, which moves on to the next; the caller frees it.
static char *take_line(const char **text)
{
    const size_t length = strcspn(*text, "\n");
    char *line = duplicate(*text, length + 1, 1);
    line[length] = 0;
    *text += length + ((*text)[length] == '\n');
    return line;
}

static void check_lines(const char *groups, int wanted)
{
    int lines = groups && *groups;
    for (const char *end = groups; end && (end = strchr(end, '\n')); end++)
        lines++;
    if (groups && lines != wanted)
        die(STATUS_BAD_DATA,
            "report.groups: must have a line for each of %d runs, has %d", wanted,
            lines);
}

// Numbered as they first occur, so that their order is that of the folders.
static void find_groups(struct study *study, const char *given)
{
    check_lines(given, study->n);
    study->group_names = json_array();
    for (int k = 0; k < study->n; k++) {
        char *name = given ? take_line(&given) : group_name(study, &study->row[k]);
        int group = 0;
        while (group < study->n_group &&
               strcmp(name, json_string_value(
                                json_array_get(study->group_names, (size_t)group))))
            group++;
        if (group == study->n_group) {
            json_array_append_new(study->group_names, text_json(name));
            study->n_group++;
        }
        study->row[k].group = group;
        free(name);
    }
}

// Leaves out of the names what all begin with, up to a slash. Folders, not letters:
// "run1" and "run2" stay whole.
static void shorten_names(struct study *study)
{
    size_t same = strlen(study->row[0].name);
    for (int k = 1; k < study->n; k++) {
        size_t c = 0;
        while (c < same && study->row[k].name[c] == study->row[0].name[c])
            c++;
        same = c;
    }
    while (same > 0 && study->row[0].name[same - 1] != '/')
        same--;
    for (int k = 0; k < study->n; k++) {
        char *name = study->row[k].name;
        memmove(name, name + same, strlen(name + same) + 1);
        if (!*name) memcpy(name, ".", 2);
    }
}

// Names and groups need all rows, so they come after the reading.
struct study *study_of(const char *const *paths, int n, const char *groups,
                       const char *output)
{
    char **folders = run_folders(paths, n, &n);
    if (!folders) return NULL;
    struct study *study = NEW_ARRAY(struct study, 1);
    study->n = n;
    study->row = NEW_ARRAY(struct row, n);
    for (int k = 0; k < n; k++) {
        study->row[k] = row_of(folders[k], output);
        free(folders[k]);
    }
    free(folders);
    shorten_names(study);
    find_differences(study);
    find_groups(study, groups);
    return study;
}

void study_free(struct study *study)
{
    if (!study) return;
    for (int k = 0; k < study->n; k++) {
        free(study->row[k].name);
        free(study->row[k].link);
        json_decref(study->row[k].scene);
    }
    json_decref(study->differing);
    json_decref(study->group_names);
    free(study->row);
    free(study);
}

// ---- samples ------------------------------------------------------------------------

// The known values of COLUMN in GROUP (-1: in all). The caller frees .value.
static struct sample sample_of(const struct study *study, int column, int group)
{
    double *value = NEW_ARRAY(double, study->n);
    int n = 0;
    for (int k = 0; k < study->n; k++) {
        const struct row *row = &study->row[k];
        if ((group < 0 || row->group == group) && isfinite(row->value[column]))
            value[n++] = row->value[column];
    }
    return (struct sample){value, n};
}

// A column is known when one run has it.
static bool is_known(const struct study *study, int column)
{
    const struct sample all = sample_of(study, column, -1);
    free((void *)all.value);
    return all.n > 0;
}

// Whether it takes two values, so that there is something to draw.
static bool scatters(const struct study *study, int column)
{
    const struct sample all = sample_of(study, column, -1);
    bool does = false;
    for (int k = 1; k < all.n; k++)
        does |= all.value[k] != all.value[0];
    free((void *)all.value);
    return does;
}

// Runs that differ in seeds at most have an empty name.
static const char *group_of(const struct study *study, int group)
{
    const char *name =
        json_string_value(json_array_get(study->group_names, (size_t)group));
    return name && *name ? name : "all runs";
}

// ---- the page -----------------------------------------------------------------------

// How many bonds broke in GROUP, on average. The interval ends at 0: a count cannot be
// less.
static void say_broken(FILE *page, const struct study *study, int group)
{
    const struct sample broken = sample_of(study, 1, group);
    const double half = half_width(broken, confidence);
    const double mean = broken.n ? sample_mean(broken) : NAN;
    char text[2][40];
    if (broken.n)
        put_line(page, "%s bond%s broke%s", plain(mean, 4, text[0]),
                 mean == 1 ? "" : "s", broken.n > 1 ? " on average" : "");
    if (isfinite(half))
        put_line(page, " (95 %% interval %s to %s)",
                 plain(fmax(0, mean - half), 4, text[0]),
                 plain(mean + half, 4, text[1]));
    free((void *)broken.value);
}

// More than three groups would make no sentence.
void put_study_headline(FILE *page, const struct study *study)
{
    put_line(page, "%d runs", study->n);
    if (study->n_group > 1) put_line(page, " in %d groups", study->n_group);
    for (int group = 0; is_known(study, 1) && group < study->n_group && group < 3;
         group++) {
        fputs(group ? "; " : ": ", page);
        if (study->n_group > 1) put_line(page, "%s: ", group_of(study, group));
        say_broken(page, study, group);
    }
    if (is_known(study, 1) && study->n_group > 3) fputs("; and so on below", page);
    fputs(".", page);
}

void put_differences(FILE *page, const struct study *study)
{
    const size_t n = json_array_size(study->differing);
    if (!n) put_line(page, "The scenes of these runs are the same.");
    for (size_t k = 0; k < n; k++)
        put_line(page, "%s%s", k ? ", " : "The scenes differ in: ",
                 json_string_value(json_array_get(study->differing, k)));
    put_line(page, n ? "." : "");
}

// Scenes may differ in any number of keys; the table has room for MOST_SHOWN.
static size_t shown_keys(const struct study *study)
{
    const size_t n = json_array_size(study->differing);
    return n < MOST_SHOWN ? n : MOST_SHOWN;
}

static void put_head(FILE *page, const struct study *study)
{
    fputs("<thead><tr><th scope=\"col\"><button type=\"button\">run</button></th>",
          page);
    for (size_t k = 0; k < shown_keys(study); k++)
        put_cell(page, "<th scope=\"col\"><button type=\"button\">",
                 json_string_value(json_array_get(study->differing, k)),
                 "</button></th>");
    for (int c = 0; c < COLUMNS; c++)
        if (is_known(study, c))
            put_cell(page, "<th scope=\"col\"><button type=\"button\">", column_name[c],
                     "</button></th>");
    fputs("</tr></thead>\n", page);
}

static void put_row(FILE *page, const struct study *study, const struct row *row)
{
    fputs("<tr><th scope=\"row\">", page);
    if (row->link) put_cell(page, "<a href=\"", row->link, "\">");
    put_text(page, row->name);
    fputs(row->link ? "</a></th>" : "</th>", page);
    for (size_t k = 0; k < shown_keys(study); k++) {
        const char *key = json_string_value(json_array_get(study->differing, k));
        char *value = value_text(json_object_get(row->scene, key));
        put_cell(page, "<td>", value, "</td>");
        free(value);
    }
    for (int c = 0; c < COLUMNS; c++) {
        char text[40] = "";
        const double value = row->value[c];
        if (isfinite(value)) plain(value, value == rint(value) ? 9 : 5, text);
        if (is_known(study, c)) put_cell(page, "<td>", text, "</td>");
    }
    fputs("</tr>\n", page);
}

void put_runs(FILE *page, const struct study *study)
{
    fputs("<table id=\"runs\">\n", page);
    put_head(page, study);
    fputs("<tbody>\n", page);
    for (int k = 0; k < study->n; k++)
        put_row(page, study, &study->row[k]);
    fputs("</tbody></table>\n", page);
}

enum { WIDE = 520, RIGHT = 30, LINE = 34, CHARACTER = 7 };

struct axis {
    double least, most;
    int left;  // where it begins, pixels of WIDE
    int above; // of the names of groups above their points; 0: they are to the left
};

// Names go to the left where all fit there, else each above its points.
static void make_room(const struct study *study, struct axis *axis)
{
    enum { BESIDE = 170 };
    axis->left = BESIDE;
    for (int group = 0; group < study->n_group; group++)
        if ((strlen(group_of(study, group)) + 1) * CHARACTER > BESIDE)
            *axis = (struct axis){axis->least, axis->most, RIGHT, 18};
}

// A name that is too long for the whole picture ends in an ellipsis: the caption has
// all of it. Bytes of one character stay together.
static void put_name(FILE *page, const char *name, struct axis axis, int top)
{
    const size_t most = (WIDE - 2 * CHARACTER) / CHARACTER;
    size_t length = strlen(name);
    const bool is_cut = axis.above && length > most;
    for (length = is_cut ? most : length; (name[length] & 0xC0) == 0x80;)
        length--;
    char *shown = duplicate(name, length + 1, 1);
    shown[length] = 0;
    fprintf(page, "<text x=\"%d\" y=\"%d\" text-anchor=\"%s\">",
            axis.above ? 0 : axis.left - 10, top + (axis.above ? 13 : LINE / 2 + 4),
            axis.above ? "start" : "end");
    put_text(page, shown);
    fputs(is_cut ? "…</text>" : "</text>", page);
    free(shown);
}

// Pixels from the left, of WIDE.
static double on_axis(struct axis axis, double value)
{
    return axis.left +
           (WIDE - axis.left - RIGHT) * (value - axis.least) / (axis.most - axis.least);
}

// Points of one group, each a little off the line that others do not hide it. Seven
// heights in turn, the same at each making; a random offset would change the bytes.
static void put_strip(FILE *page, const struct study *study, int column, int group,
                      struct axis axis)
{
    const struct sample sample = sample_of(study, column, group);
    const int top = (LINE + axis.above) * group;
    const double y = top + axis.above + LINE / 2.0,
                 mean = sample.n ? sample_mean(sample) : NAN,
                 half = half_width(sample, confidence);
    put_name(page, group_of(study, group), axis, top);
    if (isfinite(half))
        fprintf(page, "<path class=\"interval\" d=\"M%.1f %.0fH%.1f\"/>",
                on_axis(axis, fmax(mean - half, axis.least)), y,
                on_axis(axis, fmin(mean + half, axis.most)));
    if (isfinite(mean))
        fprintf(page, "<path class=\"mean\" d=\"M%.1f %.0fv20\"/>", on_axis(axis, mean),
                y - 10);
    for (int k = 0; k < sample.n; k++)
        fprintf(page, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\"/>",
                on_axis(axis, sample.value[k]), y + 7.0 * ((k * 5) % 7 - 3) / 3);
    free((void *)sample.value);
}

// From the least to the most of points and intervals; not below 0 for what never is. A
// margin of a twentieth on both sides.
static struct axis axis_of(const struct study *study, int column)
{
    struct axis axis = {.least = INFINITY, .most = -INFINITY};
    double least = INFINITY;
    for (int group = 0; group < study->n_group; group++) {
        const struct sample sample = sample_of(study, column, group);
        const double half = half_width(sample, confidence);
        for (int k = 0; k < sample.n; k++) {
            least = fmin(least, sample.value[k]);
            axis.most = fmax(axis.most, sample.value[k]);
        }
        if (isfinite(half)) {
            axis.least = fmin(axis.least, sample_mean(sample) - half);
            axis.most = fmax(axis.most, sample_mean(sample) + half);
        }
        free((void *)sample.value);
    }
    axis.least = fmin(axis.least, least);
    const double margin = 0.05 * (axis.most - axis.least);
    axis.least -= margin;
    if (least >= 0) axis.least = fmax(axis.least, 0);
    axis.most += margin;
    make_room(study, &axis);
    return axis;
}

// In words: mean, interval and number of each group.
static void put_caption(FILE *page, const struct study *study, int column)
{
    fputs("<p class=\"small\">", page);
    for (int group = 0; group < study->n_group; group++) {
        const struct sample sample = sample_of(study, column, group);
        const double half = half_width(sample, confidence);
        put_line(page, "%s%s: ", group ? "; " : "", group_of(study, group));
        const double mean = sample.n ? sample_mean(sample) : NAN;
        char text[2][40];
        if (sample.n)
            put_line(page, sample.n > 1 ? "mean %s" : "%s", plain(mean, 4, text[0]));
        if (isfinite(half))
            put_line(page, " (%s to %s)", plain(mean - half, 4, text[0]),
                     plain(mean + half, 4, text[1]));
        if (sample.n)
            put_line(page, ", %d run%s", sample.n, sample.n > 1 ? "s" : "");
        else
            put_line(page, "no run says it");
        free((void *)sample.value);
    }
    fputs("</p>\n", page);
}

// An SVG of its own for each column, under its name: a line for each group, the axis
// below with its ends and middle. The text below has the same in words.
void put_distributions(FILE *page, const struct study *study)
{
    for (int c = 0; c < COLUMNS; c++) {
        if (!scatters(study, c)) continue;
        const struct axis axis = axis_of(study, c);
        const int high = (LINE + axis.above) * study->n_group;
        put_cell(page, "<figure><figcaption>", column_name[c], "</figcaption>");
        fprintf(page, "<svg class=\"strip\" viewBox=\"0 0 %d %d\" role=\"img\" ", WIDE,
                high + 40);
        put_cell(page, "aria-label=\"", column_name[c], ", a point a run\">");
        for (int group = 0; group < study->n_group; group++)
            put_strip(page, study, c, group, axis);
        fprintf(page, "<path class=\"axis\" d=\"M%d %dH%d\"/>", axis.left, high,
                WIDE - RIGHT);
        for (int k = 0; k <= 2; k++) {
            const double value = axis.least + k * (axis.most - axis.least) / 2;
            char text[40];
            fprintf(page, "<text x=\"%.0f\" y=\"%d\" text-anchor=\"middle\">%s</text>",
                    on_axis(axis, value), high + 18, plain(value, 3, text));
        }
        fputs("</svg>\n", page);
        put_caption(page, study, c);
        fputs("</figure>\n", page);
    }
}

// A row only where Welch's test can be made: with two values in each group.
static void put_test(FILE *page, const struct study *study, int column)
{
    const struct sample a = sample_of(study, column, 0),
                        b = sample_of(study, column, 1);
    const struct welch t = welch_test(a, b);
    const struct mann_whitney u = mann_whitney_test(a, b);
    if (isfinite(t.p)) {
        put_cell(page, "<tr><th scope=\"row\">", column_name[column], "</th>");
        char text[2][40];
        fprintf(page, "<td>%s</td><td>%s</td><td>%.2g</td><td>%.2g</td></tr>\n",
                plain(sample_mean(a), 4, text[0]), plain(sample_mean(b), 4, text[1]),
                t.p, u.p);
    }
    free((void *)a.value);
    free((void *)b.value);
}

// With more groups all pairs would have to be tested, and p-values corrected for their
// number.
void put_tests(FILE *page, const struct study *study)
{
    if (study->n_group != 2) {
        fputs("<p>", page);
        put_line(page, "Two groups are tested against each other; here %s.",
                 study->n_group < 2 ? "is one, of runs that differ in seeds at most"
                                    : "are more than two");
        fputs("</p>\n", page);
        return;
    }
    fputs("<div class=\"wide\"><table id=\"tests\"><thead><tr><th "
          "scope=\"col\">mean</th>",
          page);
    for (int group = 0; group < 2; group++)
        put_cell(page, "<th scope=\"col\">", group_of(study, group), "</th>");
    fputs("<th scope=\"col\">p (Welch's t)</th><th scope=\"col\">p (Mann and Whitney's "
          "U)</th></tr></thead><tbody>\n",
          page);
    for (int c = 0; c < COLUMNS; c++)
        if (scatters(study, c)) put_test(page, study, c);
    fputs("</tbody></table></div>\n", page);
}
