// SPDX-License-Identifier: GPL-3.0-or-later
// The error function through a profile [G 13].
#ifndef CRAQUELURE_SHEARSTATS_BAND_FIT_H
#define CRAQUELURE_SHEARSTATS_BAND_FIT_H

#include <stdbool.h>

// The standard errors are those of independent scatter around the curve.
struct band_fit {
    bool converged;
    double centre, centre_error; // as R
    double width, width_error;   // of the profile before it was smoothed
    double residual;             // root mean square
};

// Fits TURNED (n), 0 inside and 1 outside, at R (n, rising). SMOOTHING is the standard
// deviation of what the profile was smoothed with. Not converged: fewer than four
// points, or none of the solution's centre or width is within the profile.
struct band_fit fit_band(const double *r, const double *turned, int n,
                         double smoothing);

#endif
