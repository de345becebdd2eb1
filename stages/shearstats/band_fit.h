// SPDX-License-Identifier: GPL-3.0-or-later
// The error function through a profile [G 13]. Its slope at the centre is 1 / (sqrt(pi)
// width), and 84 % of the change lies within a width of the centre on both sides. The
// shear rate is a Gaussian with a standard deviation of width / sqrt(2).
#pragma once

#include <stdbool.h>

// The standard errors are those of independent scatter around the curve. Lengths are in
// the unit of R, m. Not converged: all is 0, or what the iteration ended with; do not
// use it.
struct band_fit {
    bool converged;
    double centre, centre_error; // as R
    double width, width_error;   // of the profile before it was smoothed
    double residual;             // root mean square
};

// Fits TURNED (n), 0 inside and 1 outside, at R (n, rising). SMOOTHING is the standard
// deviation of what the profile was smoothed with. Not converged: fewer than four
// points, or none of the solution's centre or width is within the profile. At least two
// values of R must differ. WIDTH is 0 where SMOOTHING alone explains the spread of the
// profile.
struct band_fit fit_band(const double *r, const double *turned, int n,
                         double smoothing);
