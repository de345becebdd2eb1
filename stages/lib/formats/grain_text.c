// SPDX-License-Identifier: GPL-3.0-or-later
// Grains as text: a line each, x y z radius in m; the box is drawn around them. Numbers
// are separated by blanks, tabs, commas or semicolons. A heading, the names of columns,
// may come first (heading.h). Empty lines and comments count when a message names a
// line.
//
// It is read line by line into arrays that double. The first line that is wrong ends
// the reading: fewer or more than four numbers (or no number in a named column), a
// word, what is not finite, a radius that is not above 0. A file without any grain is
// refused, too.
#include "formats/grains.h"

#include "basics/memory.h"
#include "formats/heading.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

// Reads the first four numbers of a line; returns how many it has, or -1 where one is a
// word.
static int read_numbers(const char *line, double numbers[4])
{
    for (int count = 0;; count++) {
        line += strspn(line, " \t\r,;");
        if (!*line || *line == '#') return count;
        char *end;
        const double number = strtod(line, &end);
        if (end == line) return -1;
        if (count < 4) numbers[count] = number;
        line = end;
    }
}

// Numbers as 1,5 in a file with semicolons, as spreadsheets write where commas are
// decimal. Without semicolons such a comma parts columns.
static bool has_decimal_commas(const char *line)
{
    if (!strchr(line, ';') || strchr(line, '.')) return false;
    for (const char *c = strchr(line, ','); c; c = strchr(c + 1, ','))
        if (c > line && isdigit((unsigned char)c[-1]) && isdigit((unsigned char)c[1]))
            return true;
    return false;
}

// What to do about a LINE that has COUNT numbers.
static const char *advice(const char *line, int count)
{
    if (has_decimal_commas(line)) return "; commas are no decimal points here";
    return count > 4 ? "; keep the columns x y z r alone, or name them in a line above"
                     : "";
}

// A line without names above it has COUNT numbers. NUMBER: of the line, from 1. FIRST:
// no grain has come before, so that words may be the names of columns.
static enum status check_count(const char *line, int count, int number, bool first,
                               struct reason *reason)
{
    if (count < 0)
        return refuse(reason, STATUS_BAD_DATA,
                      "line %d: must be four numbers, x y z r, or a comment, #%s",
                      number,
                      first ? "; names of columns must have x, y, z and r (or radius) "
                              "among them, each once (call diameters r, and give "
                              "import.diameters=true)"
                            : "");
    if (count != 4)
        return refuse(
            reason, STATUS_BAD_DATA,
            "line %d: must be four numbers, x y z r, or a comment, #; has %d numbers%s",
            number, count, advice(line, count));
    return STATUS_OK;
}

// Radii are checked last, when they are numbers.
static enum status check_grain(const double grain[4], int number, struct reason *reason)
{
    for (int k = 0; k < 4; k++)
        if (!isfinite(grain[k]))
            return refuse(reason, STATUS_BAD_DATA, "line %d: must be finite, got %g",
                          number, grain[k]);
    if (grain[3] <= 0)
        return refuse(reason, STATUS_BAD_DATA,
                      "line %d: the radius must be > 0 m, got %g", number, grain[3]);
    return STATUS_OK;
}

size_t size_of_mark(const struct bytes *text)
{
    static const char mark[] = "\xef\xbb\xbf";
    const size_t size = sizeof mark - 1;
    return text->size >= size && !memcmp(text->data, mark, size) ? size : 0;
}

enum status copy_text(const struct bytes *text, char **copy, struct reason *reason)
{
    if (text->size >= 2 && !memcmp(text->data, "\x1f\x8b", 2))
        return refuse(reason, STATUS_BAD_DATA, "is compressed: unpack it by gunzip");
    if (memchr(text->data, 0, text->size))
        return refuse(reason, STATUS_BAD_DATA,
                      "holds null bytes: neither text nor HDF5");
    const size_t skipped = size_of_mark(text);
    *copy = allocate(text->size - skipped + 1, 1);
    memcpy(*copy, (const char *)text->data + skipped, text->size - skipped);
    return STATUS_OK;
}

// Surfaces, not centres: walls touch the outermost grains. Without grains the box is
// inside out.
void box_around(struct packing *packing)
{
    for (int axis = 0; axis < 3; axis++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int i = 0; i < packing->n_particle; i++) {
            low = fmin(low, component(packing->position[i], axis) - packing->radius[i]);
            high =
                fmax(high, component(packing->position[i], axis) + packing->radius[i]);
        }
        set_component(&packing->lower, axis, low);
        set_component(&packing->upper, axis, high);
    }
}

// The grain of a line, under a heading or not.
static enum status read_grain(const char *line, const struct heading *heading,
                              int number, bool first, double grain[4],
                              struct reason *reason)
{
    const char *missing = heading ? read_named_numbers(line, heading, grain) : NULL;
    if (missing)
        return refuse(reason, STATUS_BAD_DATA,
                      "line %d: must have a number in column %s%s", number, missing,
                      has_decimal_commas(line) ? "; commas are no decimal points here"
                                               : "");
    const enum status status =
        heading ? STATUS_OK
                : check_count(line, read_numbers(line, grain), number, first, reason);
    return status ? status : check_grain(grain, number, reason);
}

static bool is_blank(const char *line)
{
    line += strspn(line, " \t\r,;");
    return !*line || *line == '#';
}

// copy_text first, because strsep cuts lines in place and strtod needs an end. O(n).
enum status import_text(const struct bytes *text, struct packing *packing, double *unit,
                        struct reason *reason)
{
    *packing = (struct packing){0};
    *unit = 0;
    char *copy = NULL;
    enum status status = copy_text(text, &copy, reason);
    if (status) return status;
    int capacity = 0, number = 0;
    bool first = true, is_named = false;
    struct heading heading;
    char *rest = copy;
    for (char *line; !status && (line = strsep(&rest, "\n"));) {
        double grain[4] = {0};
        number++;
        if (is_blank(line)) continue;
        const bool names = first && read_heading(line, strlen(line), &heading);
        is_named = is_named || names;
        if (names) *unit = heading.unit;
        if (!names)
            status = read_grain(line, is_named ? &heading : NULL, number, first, grain,
                                reason);
        first = false;
        if (status) break;
        if (names) continue;
        if (packing->n_particle == capacity) {
            capacity = capacity ? 2 * capacity : 64;
            packing->position = reallocate(packing->position, (size_t)capacity,
                                           sizeof *packing->position);
            packing->radius =
                reallocate(packing->radius, (size_t)capacity, sizeof *packing->radius);
        }
        packing->position[packing->n_particle] =
            (struct vector){grain[0], grain[1], grain[2]};
        packing->radius[packing->n_particle++] = grain[3];
    }
    free(copy);
    if (!status && !packing->n_particle)
        status = refuse(reason, STATUS_BAD_DATA, "no grains");
    if (status) {
        packing_free(packing);
        return status;
    }
    packing->bond = allocate(0, sizeof *packing->bond);
    box_around(packing);
    return STATUS_OK;
}
