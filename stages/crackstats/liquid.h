// SPDX-License-Identifier: GPL-3.0-or-later
// Where the liquid is while cracks open: slices of the drying network over time.
#pragma once

#include "network/drying_record.h"

// A drying, as read from its artifact. Freed with liquid_free.
struct liquid {
    struct network network;
    struct drying_record record; // at least one step
    double first_period_end;     // s
};

// The time (s) at which the saturation of the network first is LEVEL, linear between
// the recorded steps. The first time if it begins at or below LEVEL, the last if it
// never falls so far.
double time_of_saturation(const struct liquid *liquid, double level);

// Saturation of N_SLICE slices of equal height, from the bottom up, at N_TIME times
// that do not fall. (n_time, n_slice); NAN where a slice never holds liquid. A throat
// counts in the slice of its middle, on the border of two half in each. The caller
// frees it.
double *slice_saturations(const struct liquid *liquid, int n_slice, const double *time,
                          int n_time);

void liquid_free(struct liquid *liquid);
