// SPDX-License-Identifier: GPL-3.0-or-later
// A line with the names of columns, as tables in CSV begin: grains may then have other
// columns, in any order.
#pragma once

#include <stdbool.h>
#include <stddef.h>

struct heading {
    int column[4];  // of x, y, z and the radius, from 0
    char separator; // between fields; ' ': any number of blanks
    double unit;    // m, if all four name the same other unit than this; 0: not so
};

// Whether LINE names x, y, z and r (or radius), each once. SIZE: of the line.
bool read_heading(const char *line, size_t size, struct heading *heading);

// The four numbers of a LINE below it, which ends with a null. The name of the first
// column without a number, or NULL.
const char *read_named_numbers(const char *line, const struct heading *heading,
                               double numbers[4]);
