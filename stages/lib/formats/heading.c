// SPDX-License-Identifier: GPL-3.0-or-later
// Names count in upper and lower case, with or without quotes, and with a unit in
// brackets, x (mm). Numbers are taken as they stand; the caller learns of a unit that
// all four columns name. Fields may be empty, except between blanks. Fields of other
// columns may hold anything but separators.
#include "formats/heading.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[] = {"x", "y", "z", "r"};

struct field {
    const char *at;
    size_t size;
};

// The next field before END; false after the last.
static bool next_field(const char **rest, const char *end, char separator,
                       struct field *field)
{
    if (!*rest) return false;
    const char *at = *rest;
    while (at < end && *at != separator && strchr(" \t\r", *at))
        at++;
    if (separator == ' ')
        while (at < end && isspace((unsigned char)*at))
            at++;
    if (separator == ' ' && at == end) return false;
    const char *to = at;
    while (to < end && (separator == ' ' ? !isspace((unsigned char)*to)
                                         : *to != separator && *to != '\n'))
        to++;
    *field = (struct field){at, (size_t)(to - at)};
    *rest = to < end && *to != '\n' ? to + 1 : NULL;
    return true;
}

// Which of x, y, z, r the field names; -1: none.
static int named(struct field field)
{
    if (field.size && strchr("\"'", *field.at)) {
        field.at++;
        field.size--;
    }
    size_t length = 0;
    while (length < field.size && isalnum((unsigned char)field.at[length]))
        length++;
    if (length < field.size && !strchr(" \t\r\"'([", field.at[length])) return -1;
    if (length == 6 && !strncasecmp(field.at, "radius", 6)) return 3;
    for (int k = 0; k < 4; k++)
        if (length == 1 && tolower((unsigned char)*field.at) == *names[k]) return k;
    return -1;
}

// In brackets behind the name; 0 where none is, or another. Of the two signs for micro
// one is a Greek letter.
static double unit_of(struct field field)
{
    static const struct {
        const char *name;
        double metres;
    } units[] = {{"m", 1},     {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6},
                 {"µm", 1e-6}, {"μm", 1e-6}, {"nm", 1e-9}};
    size_t from = 0, to;
    while (from < field.size && !strchr("([", field.at[from]))
        from++;
    for (from++; from < field.size && isspace((unsigned char)field.at[from]);)
        from++;
    for (to = from; to < field.size && !strchr(")] \t", field.at[to]);)
        to++;
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (to < field.size && strlen(units[k].name) == to - from &&
            !strncmp(units[k].name, field.at + from, to - from))
            return units[k].metres;
    return 0;
}

static double common_unit(const double unit[4])
{
    for (int k = 1; k < 4; k++)
        if (unit[k] != unit[0]) return 0;
    return unit[0] == 1 ? 0 : unit[0];
}

bool read_heading(const char *line, size_t size, struct heading *heading)
{
    *heading = (struct heading){{-1, -1, -1, -1}, ' ', 0};
    double unit[4] = {0};
    for (const char *mark = ";\t,"; *mark && heading->separator == ' '; mark++)
        if (memchr(line, *mark, size)) heading->separator = *mark;
    struct field field;
    const char *rest = line;
    for (int column = 0; next_field(&rest, line + size, heading->separator, &field);
         column++) {
        const int k = named(field);
        if (k >= 0 && heading->column[k] >= 0) return false;
        if (k < 0) continue;
        heading->column[k] = column;
        unit[k] = unit_of(field);
    }
    for (int k = 0; k < 4; k++)
        if (heading->column[k] < 0) return false;
    heading->unit = common_unit(unit);
    return true;
}

static bool read_number(struct field field, double *number)
{
    char *end;
    *number = strtod(field.at, &end);
    if (!field.size || end == field.at || end > field.at + field.size) return false;
    while (end < field.at + field.size && isspace((unsigned char)*end))
        end++;
    return end == field.at + field.size;
}

const char *read_named_numbers(const char *line, const struct heading *heading,
                               double numbers[4])
{
    bool found[4] = {false};
    struct field field;
    const char *rest = line, *end = line + strlen(line);
    for (int column = 0; next_field(&rest, end, heading->separator, &field); column++)
        for (int k = 0; k < 4; k++)
            if (heading->column[k] == column)
                found[k] = read_number(field, &numbers[k]);
    for (int k = 0; k < 4; k++)
        if (!found[k]) return names[k];
    return NULL;
}
