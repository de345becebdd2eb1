// SPDX-License-Identifier: GPL-3.0-or-later
// Whether two paired samples differ, such as those of the same aggregates treated in
// two ways. All tests are two-sided.
#pragma once

#include "statistics/sample.h"

// Student's t test that the differences have mean 0.
struct paired_t {
    double mean, sd; // of A's values less B's
    double t, degrees, p;
};

// A and B have the same length, at least two; else, and if a value is NAN, all are NAN.
// If the differences do not scatter, t is 0 and p 1, or t infinite and p 0.
struct paired_t paired_t_test(struct sample a, struct sample b);

// Wilcoxon's signed ranks, that the differences are symmetric about 0.
struct wilcoxon {
    double v; // sum of the ranks, by size, of differences above 0
    double p;
    bool exact;
};

// Pairs without a difference are left out. Exact for up to 50 pairs without ties or
// such pairs; else by the normal distribution, corrected for ties and continuity. P is
// 1 when no pairs are left. NAN where a value is not known.
struct wilcoxon wilcoxon_test(struct sample a, struct sample b);
