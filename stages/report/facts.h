// SPDX-License-Identifier: GPL-3.0-or-later
// What happened in a run, in sentences and numbers. All write HTML to PAGE, escaped by
// html.h. Numbers have SI units with a prefix. What an artifact does not say is left
// out; nothing here changes RUN.
#pragma once

#include "body.h"

#include <stdio.h>

// Where a fact can be seen: at a moment and a grain; -1: nowhere. KEY as course.h has
// it, GRAIN counts from 0.
struct where {
    int64_t key, grain;
};
extern const struct where nowhere;

// A term and what is known of it. FORMAT is as printf's; the text is cut at 600
// characters.
void put_fact(FILE *page, struct where where, const char *term, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

// Grains, with their diameters, and bonds; nodes and throats where there is a network.
void put_makeup(FILE *page, const struct run *run);

// One sentence that says what came out. Cracks if there is a response, else the drying,
// else grains and bonds.
void put_headline(FILE *page, const struct run *run, const struct course *course);

// A list of terms and what is known of them, each with where to look: data-key (of the
// slider) and data-grain.
void put_facts(FILE *page, const struct run *run, const struct course *course,
               const struct shown_body *body);

// A number of crackstats, or NAN.
double counted_mean(const struct run *run, const char *group, const char *name);

// The first row at which the rate is half of the first; -1: none. Also -1 where the
// rate is not known.
int row_of_half_rate(const struct course *course);

// Everything that a reader should know before trusting a number.
void put_warnings(FILE *page, const struct run *run, const struct shown_body *body);
