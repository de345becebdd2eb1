// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's XML unstructured grids, as text: what ParaView, VisIt and meshio read.
#pragma once

#include "geometry/vector.h"

#include <stdint.h>

// One array on points or cells: numbers (COMPONENTS 1 or 3). NAME is what ParaView
// shows; the caller owns all.
struct vtu_array {
    const char *name;
    const double *value; // (n * components)
    int components;
    const char
        *meaning; // of its numbers, for the legend; NULL: they speak for themselves
};

// Points, and lines between some of them, or vertices where there are none.
struct vtu_grid {
    int n_point, n_line;
    const struct vector *point;     // (n_point)
    const int32_t (*line)[2];       // (n_line) or NULL: one vertex a point
    const struct vtu_array *points; // ends with a NULL name
    const struct vtu_array *cells;  // ends with a NULL name
    const char *shown; // the array that gives the colours until someone chooses
};

// Writes PATH whole or not at all; exits as write_whole does.
void write_vtu(const char *path, const struct vtu_grid *grid);

// A series: frame files with times, as a .pvd that ParaView opens. TIME: s.
struct vtu_frame {
    char file[4096];
    double time;
};
// Writes PATH, the list of N_FRAME frames that ParaView opens, whole or not at all.
// Frames must lie in its folder: only their last names are written.
void write_pvd(const char *path, const struct vtu_frame *frames, int n_frame);
