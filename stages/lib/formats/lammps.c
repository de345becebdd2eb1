// SPDX-License-Identifier: GPL-3.0-or-later
// LAMMPS dumps in text: frames of "ITEM: ..." lines, each followed by its data. The
// frame is found first; then its box and periodic sides are read, then the names of the
// columns, then a row a grain; at the end grains are sorted by id, as LAMMPS writes
// them in any order.
//
// Boxes must be straight: tilted ones (xy xz yz) are refused. Sides are periodic where
// both flags are p. Types, velocities and other columns are passed over.
//
//     ITEM: TIMESTEP              not read; begins a frame
//     ITEM: NUMBER OF ATOMS       n
//     ITEM: BOX BOUNDS pp pp ff   low high, for x, y and z
//     ITEM: ATOMS id x y z radius ...   n rows, a number for each column
//
// Lengths are taken as they are: the caller turns them into metres. Grains are put back
// into a box along its periodic sides, as x and xu may lie beyond them.
#include "formats/grains.h"

#include "basics/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COLUMNS = 256 };

// The line being read; lines are cut in place.
struct lines {
    char *rest, *line;
    int number;
};

enum scaling { PLAIN, SCALED }; // x; xs, from 0 to 1 across the box

struct columns {
    int place[3], radius, id; // which column, from 0; -1: none
    enum scaling scaling;
    bool diameters; // in column RADIUS
};

struct grain {
    double id;
    struct vector position;
    double radius;
};

bool is_lammps(const struct bytes *text)
{
    return text->size >= 5 && !memcmp(text->data, "ITEM:", 5);
}

double lammps_unit(const struct bytes *text)
{
    static const struct {
        const char *name;
        double length;
    } units[] = {{"cgs", 1e-2},    {"micro", 1e-6}, {"nano", 1e-9},
                 {"metal", 1e-10}, {"real", 1e-10}, {"electron", 5.29177210903e-11}};
    char head[32] = "", name[16];
    memcpy(head, text->data, text->size < sizeof head ? text->size : sizeof head - 1);
    if (sscanf(head, "ITEM: UNITS %15s", name) != 1) return 0;
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (!strcmp(name, units[k].name)) return units[k].length;
    return 0;
}

// The last line may have no end.
static bool next_line(struct lines *lines)
{
    lines->line = strsep(&lines->rest, "\n");
    lines->number++;
    return lines->line && (lines->rest || *lines->line);
}

// What follows "ITEM: NAME" on the current line, or NULL when it is not that.
static const char *item(const struct lines *lines, const char *name)
{
    const size_t length = strlen(name);
    if (strncmp(lines->line, "ITEM: ", 6) || strncmp(lines->line + 6, name, length))
        return NULL;
    return lines->line + 6 + length;
}

static enum status bad_line(const struct lines *lines, const char *rule,
                            struct reason *reason)
{
    return refuse(reason, STATUS_BAD_DATA, "line %d: must be %s", lines->number, rule);
}

// Frames begin with their time step. Goes to the chosen one. Only the beginnings of
// lines are looked at, since a dump may be long.
static enum status find_frame(struct lines *lines, int64_t frame, struct reason *reason)
{
    struct lines at = *lines, last = *lines;
    int64_t count = 0;
    for (const char *c = lines->rest; c;
         c = strchr(c, '\n') ? strchr(c, '\n') + 1 : 0) {
        at.rest = (char *)(uintptr_t)c;
        if (!strncmp(c, "ITEM: TIMESTEP", 14)) {
            if (frame < 0 || count == frame) last = at;
            count++;
        }
        at.number++;
    }
    if (!count) return refuse(reason, STATUS_BAD_DATA, "no \"ITEM: TIMESTEP\" line");
    if (frame >= count)
        return refuse(reason, STATUS_BAD_DATA,
                      "frame: must be below %lld, the frames there are, got %lld",
                      (long long)count, (long long)frame);
    *lines = last;
    return STATUS_OK;
}

// "BOX BOUNDS pp ff fm", then three lines of low and high.
static enum status read_box(struct lines *lines, const char *flags,
                            struct packing *packing, struct reason *reason)
{
    char side[3][8];
    if (strstr(flags, "xy") ||
        sscanf(flags, "%7s %7s %7s", side[0], side[1], side[2]) != 3)
        return bad_line(lines, "a straight box, ITEM: BOX BOUNDS with three of pp, ff",
                        reason);
    for (int axis = 0; axis < 3; axis++) {
        double low, high;
        char more;
        if (!next_line(lines) ||
            // NOLINTNEXTLINE(cert-err34-c): out of range becomes infinite, refused next
            sscanf(lines->line, "%lf %lf %c", &low, &high, &more) != 2 ||
            !isfinite(low) || !isfinite(high) || !(low < high))
            return bad_line(lines, "the box, a lower and an upper bound", reason);
        set_component(&packing->lower, axis, low);
        set_component(&packing->upper, axis, high);
        packing->periodic[axis] = !strcmp(side[axis], "pp");
    }
    return STATUS_OK;
}

// Column NAME of a grain's places, "x", with LAMMPS' suffixes. x as it is, xu
// unwrapped, xs and xsu scaled by the box.
static bool is_place(const char *name, int axis, bool *scaled)
{
    if (name[0] != "xyz"[axis]) return false;
    const char *suffix = name + 1;
    *scaled = *suffix == 's';
    return !*suffix || !strcmp(suffix, "u") || !strcmp(suffix, "s") ||
           !strcmp(suffix, "su");
}

// The first column of an axis counts where there are several.
static enum status read_columns(const struct lines *lines, const char *names,
                                struct columns *columns, struct reason *reason)
{
    *columns = (struct columns){.place = {-1, -1, -1}, .radius = -1, .id = -1};
    char name[64];
    bool scaled[3] = {false};
    int taken;
    for (int k = 0; k < MOST_COLUMNS && sscanf(names, "%63s%n", name, &taken) == 1;
         names += taken, k++) {
        for (int axis = 0; axis < 3; axis++)
            if (columns->place[axis] < 0 && is_place(name, axis, &scaled[axis]))
                columns->place[axis] = k;
        if (!strcmp(name, "id")) columns->id = k;
        const bool diameter = !strcmp(name, "diameter");
        if (!diameter && strcmp(name, "radius")) continue;
        columns->radius = k;
        columns->diameters = diameter;
    }
    if (columns->place[0] < 0 || columns->place[1] < 0 || columns->place[2] < 0)
        return bad_line(lines, "ITEM: ATOMS with columns x, y and z (or xu, xs, xsu)",
                        reason);
    if (columns->radius < 0)
        return bad_line(lines, "ITEM: ATOMS with a column radius or diameter", reason);
    if (scaled[0] != scaled[1] || scaled[0] != scaled[2])
        return bad_line(lines, "ITEM: ATOMS with all places scaled, or none", reason);
    columns->scaling = scaled[0] ? SCALED : PLAIN;
    return STATUS_OK;
}

// The numbers of one line, as far as they are; words become NaN.
static int read_row(const char *line, double row[MOST_COLUMNS])
{
    int count = 0;
    for (line += strspn(line, " \t\r"); *line && count < MOST_COLUMNS; count++) {
        const size_t length = strcspn(line, " \t\r");
        char *end;
        row[count] = strtod(line, &end);
        if (end != line + length) row[count] = (double)NAN;
        line += length;
        line += strspn(line, " \t\r");
    }
    return count;
}

// xs is a share of the box: low + edge xs. Words in columns that nobody asks for do not
// matter; in those that are needed they are NAN, and refused.
static enum status read_grain(const struct lines *lines, const struct columns *columns,
                              const struct packing *box, struct grain *grain,
                              struct reason *reason)
{
    double row[MOST_COLUMNS];
    const int count = read_row(lines->line, row);
    int last = columns->radius > columns->id ? columns->radius : columns->id;
    for (int axis = 0; axis < 3; axis++)
        last = columns->place[axis] > last ? columns->place[axis] : last;
    if (count <= last) return bad_line(lines, "a value for each column", reason);
    bool finite = columns->id < 0 || isfinite(row[columns->id]);
    for (int axis = 0; axis < 3; axis++) {
        const double low = component(box->lower, axis);
        const double edge = component(box->upper, axis) - low;
        double at = row[columns->place[axis]];
        finite = finite && isfinite(at);
        if (columns->scaling == SCALED) at = low + edge * at;
        if (box->periodic[axis]) at -= edge * floor((at - low) / edge);
        set_component(&grain->position, axis, at);
    }
    grain->radius = row[columns->radius];
    grain->id = columns->id < 0 ? 0 : row[columns->id];
    if (!finite || !isfinite(grain->radius))
        return bad_line(lines, "finite numbers", reason);
    if (!(grain->radius > 0))
        return refuse(reason, STATUS_BAD_DATA,
                      "line %d: the radius must be > 0 m, got %g", lines->number,
                      grain->radius);
    return STATUS_OK;
}

static int by_id(const void *a, const void *b)
{
    const struct grain *first = a, *second = b;
    return (first->id > second->id) - (first->id < second->id);
}

// Of grains that are sorted by id.
static bool ids_differ(const struct grain *grain, int n)
{
    for (int i = 1; i < n; i++)
        if (grain[i - 1].id == grain[i].id) return false;
    return true;
}

// Without ids grains keep the order of the rows. Memory grows with the rows that are
// there, not with N.
static enum status read_grains(struct lines *lines, const char *names, int64_t n,
                               struct packing *packing, bool *diameters,
                               struct reason *reason)
{
    struct columns columns;
    enum status status = read_columns(lines, names, &columns, reason);
    if (status) return status;
    *diameters |= columns.diameters;
    struct grain *grain = NULL;
    int count = 0, capacity = 0; // not N at once: a damaged file may claim anything
    while (!status && count < n) {
        GROW_ARRAY(grain, count, capacity);
        status = !next_line(lines) || item(lines, "")
                     ? bad_line(lines, "a grain: fewer than ITEM: NUMBER OF ATOMS says",
                                reason)
                     : read_grain(lines, &columns, packing, &grain[count++], reason);
    }
    if (!status && columns.id >= 0) {
        qsort(grain, (size_t)count, sizeof *grain, by_id);
        if (!ids_differ(grain, count))
            status = refuse(reason, STATUS_BAD_DATA, "two grains have the same id");
    }
    if (!status) {
        packing->n_particle = count;
        packing->position = NEW_ARRAY(struct vector, count);
        packing->radius = NEW_ARRAY(double, count);
        packing->bond = allocate(0, sizeof *packing->bond);
    }
    for (int i = 0; !status && i < count; i++) {
        packing->position[i] = grain[i].position;
        packing->radius[i] = grain[i].radius;
    }
    free(grain);
    return status;
}

// Items may come in any order before ATOMS, which ends the frame.
static enum status read_frame(struct lines *lines, struct packing *packing,
                              bool *diameters, struct reason *reason)
{
    int64_t n = -1;
    bool has_box = false;
    while (next_line(lines)) {
        const char *more = item(lines, "BOX BOUNDS");
        if (more) {
            const enum status status = read_box(lines, more, packing, reason);
            if (status) return status;
            has_box = true;
        } else if (item(lines, "NUMBER OF ATOMS")) {
            char *end = NULL;
            if (next_line(lines)) n = strtoll(lines->line, &end, 10);
            if (!end || end == lines->line || n < 1 || n > 100000000)
                return bad_line(lines, "the number of atoms, from 1 to 1e8", reason);
        } else if ((more = item(lines, "ATOMS"))) {
            if (n < 0 || !has_box)
                return bad_line(
                    lines, "after ITEM: NUMBER OF ATOMS and ITEM: BOX BOUNDS", reason);
            return read_grains(lines, more, n, packing, diameters, reason);
        }
    }
    return refuse(reason, STATUS_BAD_DATA, "ends before the grains of the frame");
}

enum status import_lammps(const struct bytes *text, int64_t frame,
                          struct packing *packing, bool *diameters,
                          struct reason *reason)
{
    *packing = (struct packing){0};
    char *copy = NULL;
    enum status status = copy_text(text, &copy, reason);
    if (status) return status;
    struct lines lines = {.rest = copy};
    status = find_frame(&lines, frame, reason);
    if (!status) status = read_frame(&lines, packing, diameters, reason);
    if (status) packing_free(packing);
    free(copy);
    return status;
}
