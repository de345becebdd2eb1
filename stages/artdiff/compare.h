// SPDX-License-Identifier: GPL-3.0-or-later
// In what two artifacts differ. Provenance is left out: what was asked for may differ,
// what came out is compared.
#pragma once

#include "artifacts/artifact.h"

#include <stdio.h>

// The caller opens LINES and frees what is in it. N_DIFFERENT begins at 0 and is what
// the exit status is made from.
struct comparison {
    double tolerance; // of the largest value of a dataset, or of a lone number; of 1
                      // where that has no unit and is less, as residuals are
    const char *names[2];
    FILE *lines; // a line for each difference
    int n_different;
};

// Numbers that are whole by their schema must be equal whatever the tolerance. Exits 65
// when a dataset cannot be read. Both must be open; one pair of datasets is in memory
// at a time.
void compare_artifacts(struct comparison *comparison, const struct artifact *one,
                       const struct artifact *other);

// The same for JSON: lists in order, members by their names. Takes provenance out of
// both documents, which stay the caller's.
void compare_documents(struct comparison *comparison, json_t *one, json_t *other);

// Notes a difference: a line on LINES.
void differs(struct comparison *comparison, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Whether two lone numbers are as near each other as the tolerance asks, of the larger
// or of LEAST.
bool are_near(const struct comparison *comparison, double least, double one,
              double other);
