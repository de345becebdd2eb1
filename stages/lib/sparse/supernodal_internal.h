// SPDX-License-Identifier: GPL-3.0-or-later
// What is inside struct supernodal, for its own files only. Rows and columns are in the
// order of the factor.
#pragma once

#include "supernodal.h"

#include <stddef.h>

// Columns FIRST to FIRST + COLUMNS - 1 share ROWS rows: their own, then those below.
// Entry (row[i], first + j) of the factor is panel[j rows + i]. ROW is not owned: it
// points into struct supernodal. PARENT is the supernode of the first row below the own
// ones (elimination tree).
struct supernode {
    int first, columns, rows;
    const int *row;
    double *panel; // (columns * rows), lower triangle first
    int parent;    // or -1
};

// It owns all arrays. TARGET says where each entry of the caller's matrix goes, so that
// a new factor of the same pattern starts with one pass over the values.
struct supernodal {
    int n, n_super;
    struct supernode *super;
    int *super_of; // (n) columns
    int *place;    // (n) in the factor, of the caller's rows
    int *row;      // of all supernodes
    double *panels;
    size_t size;    // of all panels
    int n_entry;    // of the matrix
    long *target;   // (n_entry) in the panels, or -1
    int widest;     // most columns of a supernode
    int tallest;    // most rows
    double *work;   // (tallest * widest) and (PACKED * widest)
    double *lanes;  // (n * BATCH * MOST_SOLVES), of zeros between calls
    int *local;     // (tallest)
    bool *in_reach; // (n_super), false between calls
};

// Solves within SUPER: its part of X (n) becomes that of L^-1 X, and the rows below
// lose its contribution. X in the order of the factor; SUPER and those below it in the
// tree come in ascending order.
void forward_through(struct supernodal *factor, const struct supernode *super,
                     double *x);
