// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of samples: confidence intervals, and whether two groups differ.
//
// Samples point to the caller's arrays, which are only read. p is the probability of
// what was seen, or of more, if there were no difference. Rank tests of small samples
// without ties are counted exactly; `exact` says so.
#pragma once

#include <stdbool.h>

struct sample {
    const double *value;
    int n;
};

double sample_mean(struct sample sample);
double sample_deviation(struct sample sample); // n - 1; NAN for fewer than two

// Probability that Student's t is at least as far from 0 as T. GSL's own tails have
// relative errors of up to 7e-7 above 30 degrees of freedom.
double student_p(double t, double degrees);

// Half the width of the interval around the mean that holds the true one with
// probability CONFIDENCE, by Student's t. NAN for fewer than two.
double half_width(struct sample sample, double confidence);

// The same for N values with this standard DEVIATION.
double half_width_of(double deviation, int n, double confidence);

// Welch's t test of equal means; variances may differ. Two-sided.
struct welch {
    double t, degrees, p;
};

// At least two values each; else all NAN. If neither sample scatters, t is 0 and p 1,
// or t infinite and p 0.
struct welch welch_test(struct sample a, struct sample b);

// Mann and Whitney's U test, that neither sample tends to larger values. Two-sided.
struct mann_whitney {
    double u; // pairs in which A's value is the larger; a tie counts half
    double p;
    bool exact;
};

// Exact without ties and with up to 50 values in all; else by the normal distribution,
// corrected for ties and continuity. NAN when a sample is empty.
struct mann_whitney mann_whitney_test(struct sample a, struct sample b);
