// SPDX-License-Identifier: GPL-3.0-or-later
// The cells of the fields: intervals along three axes, and how much of a point, spread
// by the kernel along each axis, falls in each of them.
#pragma once

#include <stdbool.h>
#include <stddef.h>

// begin_study refuses cells smaller than a twentieth of the smoothing length, so a
// kernel of three on each side reaches 122 at most.
enum { MOST_SHARES = 128 }; // intervals that one point reaches along an axis

// Interval k goes from lower + k spacing to lower + (k + 1) spacing.
struct grid_axis {
    double lower, spacing; // m; all the angle where round
    int n;
    double half_width; // of the kernel, m; 0: points are not spread
    bool repeats;      // a side of the box follows the other
    bool reflects;     // at its lower end, 0: the axis of a cylinder
    bool everywhere;   // one interval that all points lie in
    double slack[2];   // m: points so far beyond an end of one interval lie in it, too
};

// Cells are numbered with the last axis fastest. In a cylinder the axes are r, the
// angle (everywhere), z. All its cells fill a box, or a cylinder about the axis of the
// frame.
struct grid {
    struct grid_axis axis[3];
    bool cylindrical;
};

// The intervals that a point reaches, and its share in each. One interval may occur
// twice, if the kernel is wider than a box that repeats or is reflected at the axis:
// shares of one interval add up.
struct shares {
    int n;
    int interval[MOST_SHARES];
    double share[MOST_SHARES];
};

int grid_cells(const struct grid *grid);
double cell_centre(const struct grid *grid, int cell, int axis); // m; rad
double cell_volume(const struct grid *grid, int cell);           // m3

// The number of the cell STEP further along AXIS, or -1.
int cell_beside(const struct grid *grid, int cell, int axis, int step);

// Adds VALUE (COUNT) times the share of the point AT to SUM (n_cell, STRIDE), from
// column 0 on. The share of a cell is the product of those along the axes. Cost: the
// number of cells reached times COUNT.
void spread(const struct grid *grid, const double at[3], const double *value,
            size_t count, double *sum, size_t stride);
