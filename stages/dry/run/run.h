// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a run, and what its kinds of step share. For the files of this
// folder only; others call dry_network (drying.h). All is scaled (struct drying_scale)
// but the history.
//
// An event in code order: rates from the vapour, losses of throats, the time to the
// first that has emptied (or filled, or changed by saturation_step), gas into what has
// emptied, the record. Which of the four steps does it depends on the conditions
// alone: Kelvin first, else viscous, its flow kept or not, else inviscid or immobile.
#pragma once

#include "basics/compensated.h"
#include "dry/conditions.h"
#include "dry/inviscid/emptying_times.h"
#include "dry/kelvin/kelvin_menisci.h"
#include "dry/kelvin/kelvin_viscous.h"
#include "dry/liquid/losses.h"
#include "dry/liquid/occupancy.h"
#include "dry/liquid/viscous_events.h"
#include "history.h"

// It owns its parts and arrays; drying.c makes and frees them. Parts that the kind of
// liquid does not need are zero. The history belongs to the caller of dry_network.
struct run {
    const struct drying_conditions *conditions;
    struct drying_scale scale;
    struct ring_stores rings; // what throats leave at contacts
    struct film_law film_law; // with rings=films
    struct occupancy occupancy;
    struct emptying_times times;    // inviscid or immobile liquid, no Kelvin effect
    struct liquid_flow flow;        // viscous liquid
    struct kelvin_menisci kelvin;   // Kelvin effect
    struct kelvin_viscous coupling; // both
    struct losses losses;           // viscous liquid or Kelvin effect
    struct viscous_events *events;  // viscous liquid whose flow is kept; else NULL
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
    bool *is_ended;     // (n_place_of) with losses: whether among them
    double *saturation; // (n_place_of) at that step
};

// Liquid over the throats' volume, from 1 when full to exactly 0 when all is dry.
double network_saturation(const struct run *run);

// Whether there is liquid, and the saturation is above stop_saturation.
bool goes_on(const struct run *run);

// Rate into the drying air, scaled; 0 when all is dry.
double rate_now(const struct run *run);

// Whether the saturation has reached the next snapshot of the pressures of viscous
// liquid.
bool snapshot_is_due(const struct run *run);

// What may be lost, scaled, until the saturation is just below stop_saturation, by
// rounding alone.
double left_to_stop(const struct run *run);

// Whether this moment is to be recorded, by step_interval. If events have been skipped,
// the rate of the last recorded step becomes the mean until now.
bool step_is_due(struct run *run);

// Whether this moment is to be recorded as the next step, which loses LOSS, scaled, may
// be the last, and events have been skipped: of the last step a part is cut off that is
// linear in time (truncate_history.h), so no other event may be in it.
bool last_step_but_one_is_due(struct run *run, double loss);

// Puts the ended in ascending order.
void sort_ended(struct run *run);

// Adds a step to the history, with the changes recorded since the last. Its rate is
// that of now, which holds until the next step.
void record_state(struct run *run);

// Keeps the saturation when gas first reaches the wall opposite the open one.
void note_breakthrough(struct run *run);

// Advances time with run->losses until the first throat has emptied or filled, or has
// changed by saturation_step, or the saturation has fallen to stop_saturation; gas
// fills the throats that have emptied.
void carry_out_losses(struct run *run);

// Kelvin effect: finds run->losses for the present menisci. Statuses as
// kelvin_menisci_find and kelvin_viscous_find.
enum status find_kelvin_losses(struct run *run, struct reason *reason);

// Adds the pressures of viscous liquid to the history, once for each snapshot that is
// due.
void keep_pressures(struct run *run);

// Those of snapshots that are due when no step follows, with a flow of their own.
// STATUS_NOT_CONVERGED as losses_find.
enum status keep_last_pressures(struct run *run, struct reason *reason);

// Records a step if it is due; for runs with losses. Changes come before it, ascending
// in throats.
void record_losses(struct run *run);

// STATUS_NOT_CONVERGED with a message: liquid is left, but no throat loses any.
enum status refuse_standstill(const struct run *run, struct reason *reason);

// STATUS_NOT_CONVERGED with a message: kept vapour was not found.
enum status check_vapour(const struct run *run, struct reason *reason);

// Counts steps in which no throat has emptied (IDLE). STATUS_NOT_CONVERGED after so
// many that throats must be refilling each other endlessly.
enum status note_idle(struct run *run, bool idle, struct reason *reason);

// Advance the run by one event: liquid without viscosity, or immobile; viscous liquid,
// its flow found at each event or kept; Kelvin effect, where run->losses must be those
// of now. STATUS_NOT_CONVERGED: nothing evaporates any more, or the flow is not found.
// O(what changes); each ends with all parts in agreement, so that a state may be kept
// there.
enum status drying_step_inviscid(struct run *run, struct reason *reason);
enum status drying_step_viscous(struct run *run, struct reason *reason);
enum status drying_step_kept_flow(struct run *run, struct reason *reason);
enum status drying_step_kelvin(struct run *run, struct reason *reason);
