// SPDX-License-Identifier: GPL-3.0-or-later
// An ensemble of runs: the statistics of each, and the sums of their tables. Runs are
// added one by one and forgotten: only their statistics, patterns and the sizes of
// their clusters and fragments stay. Sums are made in the order of the inputs.
#pragma once

#include "count.h"
#include "deformation.h"
#include "drying_front_correlation.h"
#include "orientation.h"
#include "pattern.h"
#include "run_statistics.h"
#include "scatter.h"
#include "sizes.h"

// Sums over the runs, not means: the report divides by n_run. It owns all arrays.
struct ensemble {
    struct classes classes;
    int n_run;                         // added so far
    double bonds;                      // of all runs together, at their start
    struct run_statistics *statistics; // (n_run)
    struct counts counts;              // this and what follows: sums over the runs
    struct squares squares;            // for the scatter over the runs (scatter.h)
    struct sizes clusters, fragments;  // of all runs, in their order
    struct orientation orientation;
    int n_snapshot;
    double *snapshot_saturation;     // (n_snapshot) at which they were taken
    struct deformation *deformation; // (n_snapshot) of the largest fragment
    int n_liquid;                    // runs whose drying is known
    struct pattern *pattern;         // (n_run) NULL: not asked for
    struct drying_front front; // over the n_liquid runs; reported if these are all
};

// An empty ensemble with room for MOST_RUNS runs, counted by CLASSES, with PATTERNS
// seen from above if they are wanted. The caller frees it with ensemble_free.
struct ensemble ensemble_init(int most_runs, struct classes classes, bool patterns);
void ensemble_free(struct ensemble *ensemble);

// Adds RUN, which must have as many snapshots as the runs before; not more runs than
// there is room for. LIQUID is the drying that loaded it; NULL: not known, then its
// statistics of the front are NAN and the front is not reported for any. Neither is
// needed afterwards. The caller has checked that they belong together.
void ensemble_add(struct ensemble *ensemble, const struct run *run,
                  const struct liquid *liquid);
