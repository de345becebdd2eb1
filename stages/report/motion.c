// SPDX-License-Identifier: GPL-3.0-or-later
// Snapshots as the page has them: places of each grain one moment after the other, as
// differences; contacts of each moment as tubes between centres, or from a centre to
// the point of a wall, in 255ths of the largest force at any moment.
//
//     moment.x, .y, .z          (n_particle, n_moment) steps of the grid, differences
//     grain.group, .material    (n_particle) where any is not 0
//     chain.count               (n_moment) contacts shown at each
//     chain.first, .second      (sum of count) grains; second = n_particle: a wall
//     chain.force               (sum of count) 1 to 255
//     chain.x, .y, .z           (those with walls) the contact points, in their order
//     TITLE.NAME.K              (n_row) line K of a chart, as floats
#include "motion.h"

#include "basics/memory.h"
#include "basics/status.h"
#include "facts.h"
#include "html.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- places -------------------------------------------------------------------------

// Grain by grain, because one grain moves little from moment to moment: differences are
// small numbers.
static void put_places(struct arrays *arrays, const struct run *run,
                       const struct shown_body *body)
{
    const size_t n = (size_t)run->packing.n_particle, moments = (size_t)body->n_moment;
    struct vector *place = artifact_get(run->motion, "/snapshots/position", NULL);
    uint32_t *value = NEW_ARRAY(uint32_t, n * moments);
    for (int axis = 0; axis < 3; axis++) {
        for (size_t i = 0; i < n; i++)
            for (size_t m = 0; m < moments; m++)
                value[i * moments + m] =
                    on_grid(&body->grid, place[(size_t)body->moment[m] * n + i], axis);
        const char name[] = {'m', 'o', 'm', 'e', 'n', 't', '.', "xyz"[axis], 0};
        arrays_put(arrays, name, value, n * moments, true);
    }
    free(place);
    free(value);
}

// Nothing where all numbers are 0: there is nothing to colour then. NUMBER is of 8
// bits. Returns what the script needs to colour by it, or NULL.
static json_t *put_numbers(struct arrays *arrays, const struct run *run,
                           const char *dataset, const char *array, const char *label)
{
    int n;
    uint8_t *number = artifact_get(run->motion, dataset, &n);
    uint32_t *value = NEW_ARRAY(uint32_t, n);
    uint8_t most = 0;
    for (int i = 0; i < n; i++) {
        value[i] = number[i];
        most = number[i] > most ? number[i] : most;
    }
    if (most) arrays_put(arrays, array, value, (size_t)n, false);
    free(number);
    free(value);
    return most ? json_pack("{s:s,s:s,s:s,s:b}", "array", array, "label", label, "of",
                            "grain", "kinds", 1)
                : NULL;
}

// ---- contacts -----------------------------------------------------------------------

struct contacts {
    int32_t (*pair)[2];
    struct vector *force, *point;
    int64_t *offset; // (n_load+1)
};

// The rows of snapshot s are offset[s] to offset[s + 1] - 1. They must add up, because
// an artifact may come from elsewhere. The caller frees it with contacts_free.
// /contacts/overlap is read for its number of rows alone.
static struct contacts contacts_of(const struct run *run)
{
    struct contacts contacts = {
        .pair = artifact_get(run->motion, "/contacts/particles", NULL),
        .force = artifact_get(run->motion, "/contacts/force", NULL),
        .point = artifact_get(run->motion, "/contacts/position", NULL),
        .offset = NEW_ARRAY(int64_t, run->n_load + 1)};
    int rows;
    free(artifact_get(run->motion, "/contacts/overlap", &rows));
    int64_t *count = artifact_get(run->motion, "/snapshots/contacts", NULL);
    for (int s = 0; s < run->n_load && contacts.offset[s] <= rows; s++)
        contacts.offset[s + 1] = contacts.offset[s] + count[s];
    free(count);
    if (contacts.offset[run->n_load] != rows)
        die(STATUS_BAD_DATA,
            "%s: /snapshots/contacts: must add up to the %d rows of /contacts",
            input_name(run->motion->path), rows);
    return contacts;
}

static void contacts_free(struct contacts *contacts)
{
    free(contacts->pair);
    free(contacts->force);
    free(contacts->point);
    free(contacts->offset);
}

// Over all snapshots, also those that are not shown: the scale does not depend on the
// choice of moments.
static double largest_force(const struct contacts *contacts, int n_load)
{
    double most = 0;
    for (int64_t k = 0; k < contacts->offset[n_load]; k++)
        most = fmax(most, norm(contacts->force[k]));
    return most;
}

enum { FIRST, SECOND, FORCE, X, COLUMNS = X + 3 };

// Those of snapshot S that are not below half of a 255th of the largest force; returns
// how many there are. COUNT is how many contacts, and how many of these with walls,
// there are so far. Weak contacts would be drawn thinner than a pixel.
static uint32_t add_chains(const struct contacts *contacts, int s,
                           const struct shown_body *body, double largest,
                           uint32_t *column[COLUMNS], size_t count[2], uint32_t wall)
{
    uint32_t shown = 0;
    for (int64_t k = contacts->offset[s]; k < contacts->offset[s + 1]; k++) {
        const long share = lround(255 * norm(contacts->force[k]) / largest);
        if (share < 1) continue;
        const int32_t other = contacts->pair[k][1];
        column[FIRST][count[0]] = (uint32_t)contacts->pair[k][0];
        column[SECOND][count[0]] = other < 0 ? wall : (uint32_t)other;
        column[FORCE][count[0]++] = (uint32_t)share;
        shown++;
        if (other >= 0) continue;
        for (int axis = 0; axis < 3; axis++)
            column[X + axis][count[1]] = on_grid(&body->grid, contacts->point[k], axis);
        count[1]++;
    }
    return shown;
}

// The second of a contact with a wall is the number of grains; the points of these, in
// their order, are arrays of their own.
static double put_chains(struct arrays *arrays, const struct run *run,
                         const struct shown_body *body)
{
    struct contacts contacts = contacts_of(run);
    const double largest = largest_force(&contacts, run->n_load);
    uint32_t *column[COLUMNS], *shown = NEW_ARRAY(uint32_t, body->n_moment);
    size_t count[2] = {0, 0};
    for (int c = 0; c < COLUMNS; c++)
        column[c] = NEW_ARRAY(uint32_t, contacts.offset[run->n_load]);
    for (int m = 0; largest > 0 && m < body->n_moment; m++)
        shown[m] = add_chains(&contacts, body->moment[m], body, largest, column, count,
                              (uint32_t)run->packing.n_particle);
    static const char *const name[] = {"chain.first", "chain.second", "chain.force",
                                       "chain.x",     "chain.y",      "chain.z"};
    arrays_put(arrays, "chain.count", shown, (size_t)body->n_moment, false);
    for (int c = 0; c < COLUMNS; c++) {
        arrays_put(arrays, name[c], column[c], count[c >= X], c < FORCE);
        free(column[c]);
    }
    free(shown);
    contacts_free(&contacts);
    return largest;
}

// ---- the history --------------------------------------------------------------------

// A line of a chart: COMPONENT of the STRIDE numbers of a row of DATASET; -1-c: the
// length of the three from c on.
struct line {
    const char *dataset;
    int stride, component;
    const char *name;
};

// Lines have a point for each row of the course, so the slider can mark its place in
// them.
static void put_line_of(struct arrays *arrays, const struct run *run,
                        const struct course *course, const struct line *line,
                        const char *array)
{
    double *from = artifact_get(run->motion, line->dataset, NULL);
    double *value = NEW_ARRAY(double, course->n_row);
    for (int k = 0; k < course->n_row; k++) {
        const double *row = from + (size_t)course->row[k] * (size_t)line->stride;
        const double *three = line->component < 0 ? row - 1 - line->component : row;
        value[k] = line->component < 0 ? hypot(hypot(three[0], three[1]), three[2])
                                       : row[line->component];
    }
    arrays_put_doubles(arrays, array, value, (size_t)course->n_row);
    free(from);
    free(value);
}

static const struct {
    const char *title, *label, *unit;
    struct line line[4];
} charts[] = {
    {"Energy",
     "energy",
     "J",
     {{"/history/kinetic_energy", 1, 0, "kinetic"},
      {"/history/elastic_energy", 1, 0, "elastic"},
      {"/history/work", 1, 0, "work done"}}},
    {"Energy lost so far",
     "energy",
     "J",
     {{"/history/dissipation", 5, 0, "dashpots"},
      {"/history/dissipation", 5, 1, "slip"},
      {"/history/dissipation", 5, 2, "local damping"}}},
    {"Stress: compression is positive",
     "stress",
     "Pa",
     {{"/history/stress", 9, 0, "xx"},
      {"/history/stress", 9, 4, "yy"},
      {"/history/stress", 9, 8, "zz"}}},
    {"Neighbours that touch", "mean number", "", {{"/history/coordination", 1, 0, ""}}},
    {"Unbalanced force",
     "over the mean contact force",
     "",
     {{"/history/unbalanced_ratio", 1, 0, ""}}},
    {"Largest overlap",
     "over the mean radius",
     "",
     {{"/history/largest_overlap", 1, 0, ""}}}};

// Lines without a dataset in this motion are left out; the chart is made in any case.
static json_t *put_chart(struct arrays *arrays, const struct run *run,
                         const struct course *course, const char *title,
                         const char *label, const char *unit, const struct line *line,
                         int n_line)
{
    json_t *lines = json_array();
    for (int k = 0; k < n_line && line[k].dataset; k++) {
        if (!artifact_has_dataset(run->motion, line[k].dataset)) continue;
        char array[80];
        snprintf(array, sizeof array, "%s.%s.%d", title, line[k].name, k);
        put_line_of(arrays, run, course, &line[k], array);
        json_array_append_new(
            lines, json_pack("{s:s,s:s}", "name", line[k].name, "array", array));
    }
    return json_pack("{s:s,s:s,s:s,s:o}", "title", title, "label", label, "unit", unit,
                     "lines", lines);
}

// The size of the force on each of the first walls. Four lines are as many as a chart
// can hold apart; walls are in the order of the scene.
static void put_wall_forces(json_t *list, struct arrays *arrays, const struct run *run,
                            const struct course *course)
{
    enum { MOST = 4 };
    int n_wall;
    free(artifact_get(run->motion, "/walls/radius", &n_wall));
    struct line line[MOST] = {{0}};
    char name[MOST][20];
    for (int w = 0; w < n_wall && w < MOST; w++) {
        snprintf(name[w], sizeof name[w], "wall %d", w);
        line[w] = (struct line){"/history/wall_force", 3 * n_wall, -1 - 3 * w, name[w]};
    }
    if (n_wall)
        json_array_append_new(list, put_chart(arrays, run, course, "Force on each wall",
                                              "force", "N", line, MOST));
}

json_t *put_motion(struct arrays *arrays, const struct run *run,
                   const struct course *course, const struct shown_body *body)
{
    put_places(arrays, run, body);
    const double largest = put_chains(arrays, run, body);
    json_t *list = json_array(), *fields = json_array();
    for (size_t k = 0; course->n_row && k < sizeof charts / sizeof *charts; k++)
        if (artifact_has_dataset(run->motion, charts[k].line[0].dataset))
            json_array_append_new(list, put_chart(arrays, run, course, charts[k].title,
                                                  charts[k].label, charts[k].unit,
                                                  charts[k].line, 4));
    if (course->n_row) put_wall_forces(list, arrays, run, course);
    json_t *group = put_numbers(arrays, run, "/particles/group", "grain.group",
                                "grains by group"),
           *material = put_numbers(arrays, run, "/particles/material", "grain.material",
                                   "grains by material");
    if (group) json_array_append_new(fields, group);
    if (material) json_array_append_new(fields, material);
    return json_pack("{s:o,s:o,s:f}", "fields", fields, "charts", list, "contact",
                     largest);
}

// ---- in words -----------------------------------------------------------------------

static double number(const struct run *run, const char *name)
{
    return artifact_get_number(run->motion, name);
}

void put_motion_headline(FILE *page, const struct run *run)
{
    char time[40];
    put_line(page, "%d grains moved for %s%s.", run->packing.n_particle,
             with_unit(number(run, "/summary/time"), "s", time),
             number(run, "/summary/ended") > 0 ? ", until they were at rest" : "");
    if (run->packing.n_bond)
        put_line(page, " %d of %d bonds broke.", run->n_crack, run->packing.n_bond);
}

// The last number of a row of the history. NAN where the history has no row.
static double at_end(const struct run *run, const char *name)
{
    int n;
    double *value = artifact_get(run->motion, name, &n);
    const double last = n ? value[n - 1] : NAN;
    free(value);
    return last;
}

// The largest number and its row, WHEN; 0 and row 0 where none is above 0.
static double peak(const struct run *run, const char *name, int *when)
{
    int n;
    double *value = artifact_get(run->motion, name, &n), most = 0;
    *when = 0;
    for (int k = 0; k < n; k++)
        if (value[k] > most) {
            most = value[k];
            *when = k;
        }
    free(value);
    return most;
}

// What energy is not where it should be: work done less what there is now more, and
// less what is lost. At the last row, over the largest energy at any row: the sum of
// five kinds of loss, as schemas/motion.json lists them.
static void put_balance(FILE *page, const struct run *run)
{
    if (!artifact_has_dataset(run->motion, "/history/work") ||
        !artifact_has_dataset(run->motion, "/history/dissipation"))
        return;
    int n;
    double *kinetic = artifact_get(run->motion, "/history/kinetic_energy", &n);
    double *elastic = artifact_get(run->motion, "/history/elastic_energy", NULL);
    double *work = artifact_get(run->motion, "/history/work", NULL);
    double *lost = artifact_get(run->motion, "/history/dissipation", NULL);
    double moved = 0, rest = 0;
    for (int k = 0; k < n; k++) {
        double gone = 0;
        for (int c = 0; c < 5; c++)
            gone += lost[5 * k + c] - lost[c];
        rest = work[k] - work[0] - gone - (kinetic[k] - kinetic[0]) -
               (elastic[k] - elastic[0]);
        moved = fmax(moved, fmax(fabs(gone), fmax(kinetic[k], elastic[k])));
    }
    if (moved > 0)
        put_fact(page, nowhere, "Energy unaccounted for at the end",
                 "%.2g of the largest that moved, was stored or lost",
                 fabs(rest) / moved);
    free(kinetic);
    free(elastic);
    free(work);
    free(lost);
}

// Speeds are those of snapshots, energies and overlaps those of the history, which has
// more rows.
void put_motion_facts(FILE *page, const struct run *run, const struct course *course,
                      const struct shown_body *body)
{
    char text[40], when[40];
    int row;
    fputs("<dl class=\"facts\">\n", page);
    if (body->largest_load > 0)
        put_fact(page,
                 (struct where){key_of(course, body->heaviest_time), body->heaviest},
                 "Fastest", "grain %d, %s at %s (of the snapshots)", body->heaviest,
                 with_unit(body->largest_load, "m/s", text),
                 with_unit(body->heaviest_time, "s", when));
    double *time = artifact_get(run->motion, "/history/time", NULL);
    const double energy = peak(run, "/history/kinetic_energy", &row);
    if (energy > 0)
        put_fact(page, (struct where){key_of(course, time[row]), -1},
                 "Most kinetic energy", "%s at %s", with_unit(energy, "J", text),
                 with_unit(time[row], "s", when));
    const double overlap = peak(run, "/history/largest_overlap", &row);
    if (overlap > 0)
        put_fact(page, (struct where){key_of(course, time[row]), -1}, "Largest overlap",
                 "%.3g of the mean radius, at %s", overlap,
                 with_unit(time[row], "s", when));
    free(time);
    put_fact(page, nowhere, "At the end",
             "%.3g neighbours that touch; unbalanced ratio %.2g",
             at_end(run, "/history/coordination"),
             at_end(run, "/history/unbalanced_ratio"));
    put_balance(page, run);
    put_fact(page, nowhere, "Time steps", "%.0f, of %s at the end",
             number(run, "/summary/cycles"),
             with_unit(number(run, "/summary/time_step"), "s", text));
    if (run->n_crack) {
        const int32_t *bond = run->packing.bond[run->crack_bond[0]];
        put_fact(page, (struct where){key_of(course, run->crack_time[0]), bond[0]},
                 "First crack", "at %s, in %s, between grains %d and %d",
                 with_unit(run->crack_time[0], "s", when),
                 run->crack_mode[0] ? "shear" : "tension", bond[0], bond[1]);
    }
    put_makeup(page, run);
    fputs("</dl>\n", page);
}
