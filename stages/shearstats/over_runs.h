// SPDX-License-Identifier: GPL-3.0-or-later
// The mean of a number over the runs that have it. Runs are independent realisations,
// so Student's interval is honest, unlike one from snapshots of a single run.
#pragma once

// N of them have it; 0: the mean is 0. The standard error of the mean, and half its
// Student's interval, are 0 for fewer than two.
struct over_runs {
    int n;
    double mean, standard_error, half_width;
};

// Over the values (N) that are not NAN. CONFIDENCE in (0, 1), say 0.95. standard_error
// = deviation / sqrt(n), half_width = t(n - 1) times that.
struct over_runs over_runs(const double *value, int n, double confidence);
