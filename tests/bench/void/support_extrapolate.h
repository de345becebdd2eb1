// SPDX-License-Identifier: GPL-3.0-or-later
// The limit of values on ever finer grids.
#pragma once

enum { RESOLUTIONS = 3 };

struct limit {
    double value, order, error; // relative error
};

// VALUE = limit + C CELLS^-order through all three, coarsest first. Where they show no
// order between 1 and 3, the last two with order 2. The error is half of the last step,
// or how far the limit moves with an order of 1.5 or 2, where that is more.
struct limit extrapolate(const int cells[RESOLUTIONS], const double value[RESOLUTIONS]);

// One line of JSON: porosity, cells, values of N directions, their limits and errors.
void print_limits(double porosity, const int cells[RESOLUTIONS], int n,
                  double (*value)[RESOLUTIONS]);
