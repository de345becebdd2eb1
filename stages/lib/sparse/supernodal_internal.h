// SPDX-License-Identifier: GPL-3.0-or-later
// What is inside struct supernodal, for the files that make it up only. Rows and
// columns in the order of the factor.
#ifndef CRAQUELURE_SUPERNODAL_STATE_H
#define CRAQUELURE_SUPERNODAL_STATE_H

#include "supernodal.h"

#include <stddef.h>

// Columns FIRST to FIRST + COLUMNS - 1 share ROWS rows: their own, then those below.
struct supernode {
    int first, columns, rows;
    const int *row;
    double *panel; // (columns * rows), lower triangle first
    int parent;    // or -1
};

struct supernodal {
    int n, n_super;
    struct supernode *super;
    int *super_of; // (n) columns
    int *place;    // (n) in the factor, of the caller's rows
    int *row;      // of all supernodes
    double *panels;
    size_t size;     // of all panels
    int n_entry;     // of the matrix
    long *target;    // (n_entry) in the panels, or -1
    int widest;      // most columns of a supernode
    int tallest;     // most rows
    double *work;    // (tallest * widest) and (PACKED * widest)
    double *lanes;   // (n * BATCH * MOST_SOLVES), of zeros between calls
    int *local;      // (tallest)
    bool *is_on_way; // (n_super), false between calls
};

// X (n), in the order of the factor, becomes L^-1 X as far as SUPER is concerned.
void forward_through(struct supernodal *factor, const struct supernode *super,
                     double *x);

#endif
