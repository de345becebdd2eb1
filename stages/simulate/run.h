// SPDX-License-Identifier: GPL-3.0-or-later
// The run: cycles of the engine between the moments at which something is recorded or
// changed. The only file of the stage that advances the engine. It knows nothing of
// artifacts.
#pragma once

#include "checkpoint/keeper.h"
#include "record.h"

// In time: after `duration`. At rest: the unbalanced ratio [K 4.20] fell below
// stop.unbalanced_ratio, not before stop.after.
enum ending { ENDED_IN_TIME, ENDED_AT_REST };

// What came out of a run; freed with outcome_free.
struct outcome {
    struct dem *dem; // as it is at the end
    struct record record;
    enum ending ending;
};
void outcome_free(struct outcome *outcome);

// s between two snapshots.
double snapshot_interval(const struct simulate_parameters *parameters);

// Runs SCENE. FORCE (n_particle) N acts besides; may be NULL. TELL gets the fraction of
// the duration that is done. KEEPER may be NULL. The caller frees *OUTCOME with
// outcome_free, also on failure. STATUS_NOT_CONVERGED: past the stability limit,
// diverged, or grains crushed into each other; STATUS_BAD_DATA: an impossible scene or
// a checkpoint of another. SCENE is not const because its number of threads is set;
// results do not depend on THREADS. A run that continues from KEEPER's state gives the
// same bytes as an uninterrupted one. A record is made at the cycle nearest to its due
// time, and has the time of that cycle.
enum status run_scene(const struct simulate_parameters *parameters, struct scene *scene,
                      const struct vector *force, int threads,
                      void (*tell)(void *context, double fraction), void *context,
                      const struct keeper *keeper, struct outcome *outcome,
                      struct reason *reason);
