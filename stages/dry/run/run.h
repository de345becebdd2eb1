// SPDX-License-Identifier: GPL-3.0-or-later
// A run on its way, and what its two ways of going on share.
#ifndef CRAQUELURE_RUN_H
#define CRAQUELURE_RUN_H

#include "basics/compensated.h"
#include "dry/conditions.h"
#include "dry/inviscid/emptying_times.h"
#include "dry/kelvin/kelvin_menisci.h"
#include "dry/kelvin/kelvin_viscous.h"
#include "dry/liquid/losses.h"
#include "dry/liquid/occupancy.h"
#include "history.h"

struct run {
    const struct drying_conditions *conditions;
    struct drying_scale scale;
    struct occupancy occupancy;
    struct emptying_times times;    // of liquid without viscosity, or immobile
    struct liquid_flow flow;        // of viscous liquid
    struct kelvin_menisci kelvin;   // of menisci with vapour pressures of their own
    struct kelvin_viscous coupling; // of the last two
    struct losses losses;           // of the last three
    int n_idle;                     // viscous: steps since a throat has emptied
    int64_t n_flow_step;            // viscous, curved: steps so far, recorded or not
    struct recorder recorder;
    struct compensated time, evaporated; // scaled
    double first_rate;                   // scaled
    int n_at_start;                      // throats with liquid
    double imbalance;                    // largest at a step

    // Since the last step was recorded.
    double step_saturation;
    struct compensated step_time, step_evaporated;
    int n_skipped;      // events
    int n_ended;        // throats that have emptied; with losses: that have changed
    int *ended;         // (n_ended)
    bool *is_ended;     // (n_throat) with losses: whether among them
    double *saturation; // (n_throat) at that step
};

// Of the throats' volume, from 1 at the start to exactly 0 when all is dry.
double network_saturation(const struct run *run);

// Whether there is liquid, and more than where the run is to stop.
bool goes_on(const struct run *run);

// Into the drying air, scaled; 0 when all is dry.
double rate_now(const struct run *run);

// Whether the pressures of viscous liquid are asked for now.
bool snapshot_is_due(const struct run *run);

// Whether this moment is to be recorded. Where events have been passed over, the rate
// of the last step becomes the mean until now.
bool step_is_due(struct run *run);

// Puts the ended in ascending order.
void sort_ended(struct run *run);

// Adds a step to the history, with the changes recorded since the last.
void record_state(struct run *run);

// Keeps the saturation when gas first reaches the wall opposite the open one.
void note_breakthrough(struct run *run);

// Until the first throat has emptied or filled, or changed by saturation_step, all lose
// as run->losses say; gas fills what has emptied.
void carry_out_losses(struct run *run);

// With menisci that have vapour pressures of their own: finds the losses of now.
enum status find_kelvin_losses(struct run *run, struct reason *reason);

// Keeps the pressures of viscous liquid as often as they are due.
void keep_pressures(struct run *run);

// Records the step that follows if it is time for one; with losses.
void record_losses(struct run *run);

// STATUS_NOT_CONVERGED: no throat loses any more, and some are wet.
enum status refuse_standstill(const struct run *run, struct reason *reason);

// STATUS_NOT_CONVERGED if throats refill in turn for ever. IDLE: none has emptied.
enum status note_idle(struct run *run, bool idle, struct reason *reason);

// One event on: liquid without viscosity, or immobile; viscous liquid; menisci with
// vapour pressures of their own, the losses being those of now.
// STATUS_NOT_CONVERGED: nothing evaporates any more, or the flow is not found.
enum status drying_step_inviscid(struct run *run, struct reason *reason);
enum status drying_step_viscous(struct run *run, struct reason *reason);
enum status drying_step_kelvin(struct run *run, struct reason *reason);

#endif
