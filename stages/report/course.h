// SPDX-License-Identifier: GPL-3.0-or-later
// The course of a run: rows over time that the slider of the page moves through. What
// happens has a key: the row at which it does, in fractions of a row.
#pragma once

#include "arrays.h"
#include "run.h"

// The largest of 16 bits; no row has it.
enum { NEVER = 65535 }; // a key

// ROW, TIME and SATURATION have n_row numbers; times rise.
struct course {
    int n_row;          // 0: nothing changes over time
    int *row;           // (n_row) of the history it is chosen from
    double *time;       // s
    double *saturation; // 0 where nothing dries
    double *rate;       // (n_row) kg/s; NULL: not known
    double *clusters;   // (n_row) NULL likewise
    int keys_a_row;     // keys between two rows
};

// Of the drying, else the response, else the forces; of at most MOST rows, evenly
// spaced along time and saturation together. The caller frees it with course_free.
struct course course_of(const struct run *run, int most);
void course_free(struct course *course);

// When TIME is. TIME in s; one outside of the course gets the first or the last key.
uint32_t key_of(const struct course *course, double time);

// The saturation then. Linear between rows; NAN where there is no row.
double saturation_at(const struct course *course, double time);

// Rows, and what is counted over them: cracks by mode, suction. Arrays course.time (s),
// .saturation, .rate (kg/s), .clusters, .tension, .shear: (n_row) each, those that are
// known.
void put_course(struct arrays *arrays, const struct course *course,
                const struct run *run);
