// SPDX-License-Identifier: GPL-3.0-or-later
// Runs added up: the facts of each, and the tables of all together.
#ifndef CRAQUELURE_CRACKSTATS_STUDY_H
#define CRAQUELURE_CRACKSTATS_STUDY_H

#include "count.h"
#include "deformation.h"
#include "drying_front_correlation.h"
#include "orientation.h"
#include "run_statistics.h"
#include "scatter.h"
#include "sizes.h"

struct study {
    struct classes classes;
    int n_run;
    double bonds;         // of all runs together, at their start
    struct facts *facts;  // (n_run)
    struct counts counts; // this and what follows: sums over the runs
    struct squares squares;
    struct sizes clusters, fragments;
    struct orientation orientation;
    int n_snapshot;
    double *snapshot_saturation;     // (n_snapshot)
    struct deformation *deformation; // (n_snapshot)
    int n_liquid;                    // runs whose drying is known
    struct front front;
};

struct study study_new(int most_runs, struct classes classes);
void study_free(struct study *study);

// Adds RUN, which has as many snapshots as those before, and the LIQUID it dried from;
// NULL: not known.
void study_add(struct study *study, const struct run *run, const struct liquid *liquid);

#endif
