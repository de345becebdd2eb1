// SPDX-License-Identifier: GPL-3.0-or-later
// The course of a run: rows over time that the slider of the page moves through. What
// happens has a key: the row at which it does, in fractions of a row.
#ifndef CRAQUELURE_REPORT_COURSE_H
#define CRAQUELURE_REPORT_COURSE_H

#include "arrays.h"
#include "run.h"

enum { NEVER = 65535 }; // a key

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

// When TIME is.
uint32_t key_of(const struct course *course, double time);

// The saturation then.
double saturation_at(const struct course *course, double time);

// Rows, and what is counted over them: cracks by mode, suction.
void put_course(struct arrays *arrays, const struct course *course,
                const struct run *run);

#endif
