// SPDX-License-Identifier: GPL-3.0-or-later
// Which numbers make up the state of the discrete elements, by name, and where they
// are.
#ifndef CRAQUELURE_STATE_COLUMNS_H
#define CRAQUELURE_STATE_COLUMNS_H

#include "dem/engine.h"

// WIDTH numbers in each of ROWS rows; LEAST and MOST are what they may be.
struct column {
    const char *name;
    enum array_type type;
    int width;
    int64_t rows;
    void *base;
    size_t offset, stride; // bytes, from row to row or from group to group
    bool in_lanes;         // rows are the lanes of groups
    double least, most;
};

struct column_list {
    struct column column[64];
    int count;
};

// All of DEM but which bonds are intact; through the list they can be changed.
struct column_list list_columns(struct dem *dem);

// Of number K of ROW.
char *column_address(const struct column *column, int64_t row, int k);

#endif
