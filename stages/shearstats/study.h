// SPDX-License-Identifier: GPL-3.0-or-later
// One or several realisations of the same, each averaged and fitted by itself.
// begin_study looks at the first motion for whatever the user left open: smoothing from
// its mean diameter, the grid from what its grains span, levels from the height of the
// bed. Later motions are measured with the same.
#pragma once

#include "band.h"
#include "basics/status.h"
#include "fields.h"
#include "parameters.h"
#include "rheology.h"
#include "separations.h"
#include "torque.h"

// What one motion gives. It owns its arrays. SNAPSHOTS counts those of the window.
// Block errors are NAN where fewer than two blocks gave a value.
struct run_result {
    int snapshots;
    double mass_inside; // share of the mass of free grains that is in the grid
    struct fields fields;
    double *turned;         // (n_level, n_r) share of the angular velocity
    bool *turned_counts;    // (n_level, n_r)
    struct band_fit *level; // (n_level)
    double *centre_block_error, *width_block_error; // (n_level) NAN: fewer than two
    struct line_fit line;
    double friction_block_error, cohesion_block_error;
    struct torque torque;
    struct separations separations;
    double zone_volume[ZONES]; // of cells with grains, m3
};

// What is the same for all: made from the first motion. Free with study_free, also
// after a failure of begin_study.
struct study {
    struct frame frame;
    struct grid grid;
    double diameter, smoothing; // mean diameter and smoothing length, m
    struct flowing flowing;
    struct split_cell cell; // n_level is 0 where there is none
    double *height;         // of its levels; owned
    bool has_part;          // whose torque is asked for
    double class_width;
    int n_run;
    struct run_result *run; // (n_run)
};

// Sets up STUDY for up to MOST_RUNS runs of which MOTION is the first. STATUS_BAD_DATA
// where the grid would not do. Or cylindrical coordinates in a box that repeats, no
// free grain, or levels in a bed too low for them.
enum status begin_study(struct study *study, const struct motion *motion,
                        const struct shearstats_parameters *parameters, int most_runs,
                        struct reason *reason);
void study_free(struct study *study);

// Adds a run; parts of it go to THREADS threads, and the result is the same for any.
// begin_study must have come first, with at least as many MOST_RUNS. STATUS_BAD_DATA: a
// wall or group of the part is not in this motion.
enum status add_run(struct study *study, const struct motion *motion,
                    const struct shearstats_parameters *parameters, int threads,
                    struct reason *reason);
