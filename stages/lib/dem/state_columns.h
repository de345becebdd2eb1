// SPDX-License-Identifier: GPL-3.0-or-later
// The state of the discrete elements as named columns, and where each lies in memory.
#pragma once

#include "dem/engine.h"

// WIDTH numbers in each of ROWS rows, each between LEAST and MOST. NAME is that of the
// dataset in a checkpoint. In lanes, row r is lane r % 8 of group r / 8.
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

// A value; its names are static.
struct column_list {
    struct column column[128]; // more than any scene has
    int count;
};

// All state of DEM except which bonds are intact. The columns point into DEM and are
// valid until its arrays change; DEM can be changed through them. Which columns there
// are depends on the scene (liquid, bonds, rolling). Scaled units.
struct column_list list_columns(struct dem *dem);

// Address of number K of row ROW. K counts from 0 to width - 1. Of the type of the
// column. Not checked: ROW and K must be in range.
char *column_address(const struct column *column, int64_t row, int k);
