// SPDX-License-Identifier: GPL-3.0-or-later
// Whether cracks open where the liquid leaves [K 5.8, Fig. 5.19].
#pragma once

#include "count.h"
#include "liquid.h"

enum { LOCAL_CLASSES = 10 };

// For one run, or summed over many. A crack counts half in each slice of its bond
// (slices_of_bond).
struct drying_front {
    double *first; // (n_slice) saturation of each slice as drying begins
    double *slice; // (n_interval, n_slice) saturation of each slice when the network's
                   // is (n_interval - k - 1) / n_interval; NAN without liquid
    double local[LOCAL_CLASSES]; // cracks by the saturation of their slice, 1 to 0
    double local_sum;            // sum of these saturations over the cracks
    double cracks;               // number of cracks in that sum
};

// All 0. The caller frees it with drying_front_free.
struct drying_front drying_front_init(struct classes classes);
void drying_front_free(struct drying_front *front);

// Adds RUN, whose forces come from LIQUID: the saturations of its slices, and for each
// crack the saturation of its slice at that time. Cracks where there never was liquid
// are left out. O(throats) for each different time of a crack.
void drying_front_add(struct drying_front *front, const struct run *run,
                      const struct liquid *liquid, struct classes classes);

// Adds FRONT to SUM, both made for CLASSES.
void drying_front_sum(struct drying_front *sum, const struct drying_front *front,
                      struct classes classes);

// Pearson's correlation, over all slices and intervals of saturation, of the cracks
// that opened in them (counts.place) with the saturation that the slice lost. FIRST,
// SLICE and PLACE are those of one run, or sums over the same runs. NAN if either is
// the same everywhere.
double front_correlation(const double *first, const double *slice, const double *place,
                         struct classes classes);
