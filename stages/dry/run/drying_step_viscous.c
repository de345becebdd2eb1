// SPDX-License-Identifier: GPL-3.0-or-later
// Viscous liquid whose flow is found at each step: advances to the moment at which a
// throat has emptied or filled, or has changed by saturation_step. Losses are constant
// in between:
//     duration = min over throats of left / loss   (or lacking / -loss where it fills),
//     liquid -= loss duration.
// The conductances follow the filled length, so saturation_step is the accuracy in
// time; at 1 the flow is only found again at events, as K does. Throats that empty or
// fill within TIE of their volume do so together. The step that would pass
// stop_saturation ends there, as pressures that are kept of the end must not be those
// of a later moment at which another throat has emptied.
#include "run.h"

#include "basics/memory.h"

#include <math.h>

// Throats that have this part of their volume left, or less, when another empties would
// have emptied with it but for rounding.
static const double TIE = 1e-12;

// Time until the first throat has emptied or filled, or changed by saturation_step.
static double time_to_first(const struct run *run)
{
    double shortest = INFINITY;
    for (int k = 0; k < run->losses.n; k++) {
        const struct loss *loss = &run->losses.loss[k];
        const double volume = run->occupancy.volume[loss->throat];
        const double left = compensated_value(run->occupancy.liquid[loss->throat]);
        shortest = fmin(shortest, loss->rate > 0 ? left / loss->rate
                                                 : (volume - left) / -loss->rate);
        if (run->conditions->liquid == LIQUID_VISCOUS)
            shortest = fmin(shortest, run->conditions->saturation_step * volume /
                                          fabs(loss->rate));
    }
    return shortest;
}

// THROAT loses AMOUNT (negative: gains). If less than TIE of its volume would be left,
// or be missing, it empties, or fills, exactly.
static void lose(struct occupancy *occupancy, int throat, double amount)
{
    struct compensated *liquid = &occupancy->liquid[throat];
    const double before = compensated_value(*liquid);
    const double volume = occupancy->volume[throat];
    if (amount < 0 && before - amount > volume * (1 - TIE)) {
        *liquid = (struct compensated){.value = volume};
        compensated_add(&occupancy->total_liquid, volume - before);
    } else if (before - amount > TIE * volume) {
        compensated_add(liquid, -amount);
        compensated_add(&occupancy->total_liquid, -amount);
    } else {
        *liquid = (struct compensated){0};
        compensated_add(&occupancy->total_liquid, -before);
    }
}

// Lets all throats lose for DURATION, and notes which have changed.
static void advance(struct run *run, double duration)
{
    struct occupancy *occupancy = &run->occupancy;
    compensated_add(&run->time, duration);
    compensated_add(&run->evaporated, rate_now(run) * duration);
    for (int k = 0; k < run->losses.n; k++) {
        const struct loss *loss = &run->losses.loss[k];
        lose(occupancy, loss->throat, loss->rate * duration);
        if (!run->is_ended[loss->throat]) run->ended[run->n_ended++] = loss->throat;
        run->is_ended[loss->throat] = true;
    }
}

// Records all throats that have lost or filled since the last step, in ascending order.
static void record_changes(struct run *run)
{
    sort_ended(run);
    for (int k = 0; k < run->n_ended; k++) {
        const int throat = run->ended[k];
        const double saturation = occupancy_saturation(&run->occupancy, throat);
        run->is_ended[throat] = false;
        if (saturation == run->saturation[throat]) continue; // too little to show
        recorder_add_change(&run->recorder, throat, saturation);
        run->saturation[throat] = saturation;
    }
    run->n_ended = 0;
}

static void record_step(struct run *run)
{
    record_changes(run);
    record_state(run);
}

static void note_refills(struct run *run, double time)
{
    const struct occupancy *occupancy = &run->occupancy;
    for (int k = 0; k < run->losses.n; k++) {
        const struct loss *loss = &run->losses.loss[k];
        if (loss->rate < 0 && occupancy_saturation(occupancy, loss->throat) == 1)
            recorder_add_event(&run->recorder, time, loss->throat, EVENT_REFILLED);
    }
}

// Gas fills what has emptied [K 3.4.2, step 6].
static void empty_throats(struct run *run)
{
    struct occupancy *occupancy = &run->occupancy;
    const double time = compensated_value(run->time) * run->scale.time;
    note_refills(run, time);
    for (int k = 0; k < run->losses.n; k++) {
        const int throat = run->losses.loss[k].throat;
        if (occupancy->liquid[throat].value != 0) continue;
        if (run->conditions->kelvin)
            kelvin_menisci_empty_throat(&run->kelvin, occupancy, throat);
        else
            occupancy_empty_throat(occupancy, throat);
        if (run->flow.solver) liquid_flow_follow(&run->flow, occupancy, throat);
        recorder_add_event(&run->recorder, time, throat, EVENT_EMPTIED);
    }
    note_breakthrough(run);
}

void carry_out_losses(struct run *run)
{
    const double duration = fmin(time_to_first(run), left_to_stop(run) / rate_now(run));
    if (last_step_but_one_is_due(run, rate_now(run) * duration)) record_step(run);
    advance(run, duration);
    empty_throats(run);
}

void record_losses(struct run *run)
{
    if (step_is_due(run)) record_step(run);
}

static void keep_pressures_once(struct run *run)
{
    struct drying_history *history = run->recorder.history;
    const size_t n = (size_t)run->occupancy.network->n_node;
    if (!history->pressure)
        history->pressure = NEW_ARRAY(double, n *(size_t)run->conditions->n_snapshot);
    double *pressure = history->pressure + n * (size_t)history->n_pressure++;
    for (size_t i = 0; i < n; i++)
        pressure[i] = run->flow.pressure[i] * run->flow.menisci.pressure;
}

void keep_pressures(struct run *run)
{
    while (snapshot_is_due(run))
        keep_pressures_once(run);
}

// Snapshots at or below stop_saturation show the end, after which no step finds them.
enum status keep_last_pressures(struct run *run, struct reason *reason)
{
    if (!snapshot_is_due(run) || run->occupancy.n_liquid == 0) return STATUS_OK;
    if (run->events) viscous_events_forget(run->events);
    run->flow.wants_pressures = true;
    const enum status status =
        losses_find(&run->losses, &run->occupancy, &run->flow, reason);
    if (!status) keep_pressures(run);
    return status;
}

// Throats may refill in turn, but not endlessly.
enum status note_idle(struct run *run, bool idle, struct reason *reason)
{
    run->n_idle = idle ? run->n_idle + 1 : 0;
    const double most =
        100.0 * (run->occupancy.n_liquid + 10) / run->conditions->saturation_step;
    if (run->n_idle < most) return STATUS_OK;
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "throats refilled %d times over, and none has emptied, with %d still "
                  "wet (a smaller saturation_step may help)",
                  run->n_idle, run->occupancy.n_liquid);
}

enum status drying_step_viscous(struct run *run, struct reason *reason)
{
    struct occupancy *occupancy = &run->occupancy;
    run->flow.wants_pressures = snapshot_is_due(run);
    enum status status = losses_find(&run->losses, occupancy, &run->flow, reason);
    if (status) return status;
    keep_pressures(run);
    if (run->losses.n == 0) return refuse_standstill(run, reason);
    const int n_before = occupancy->n_liquid;
    carry_out_losses(run);
    run->n_flow_step++;
    record_losses(run);
    return note_idle(run, occupancy->n_liquid == n_before, reason);
}
