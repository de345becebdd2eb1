// SPDX-License-Identifier: GPL-3.0-or-later
// Viscous liquid whose flow is kept for a while (flow_step): advances to the moment at
// which the next throat has emptied or refilled (viscous_events.h), or the saturation
// has fallen to stop_saturation.
//
// Everything that is kept is forgotten where the vapour is found again without a
// factor from before: only there may a checkpoint be made, and a run that continues
// makes the same bytes.
#include "run.h"

#include <math.h>

// Saturations of now, of throats that differ from the last recorded step, ascending.
static void record_changes(struct run *run)
{
    for (int t = 0; t < run->occupancy.network->n_throat; t++) {
        if (run->saturation[t] == 0) continue;
        const double saturation = viscous_events_saturation(run->events, t);
        if (saturation == run->saturation[t]) continue; // too little to show
        recorder_add_change(&run->recorder, t, saturation);
        run->saturation[t] = saturation;
    }
}

static void record_step(struct run *run)
{
    record_changes(run);
    record_state(run);
}

// Pressures that are kept are those of a flow found at that moment.
static enum status find_losses(struct run *run, struct reason *reason)
{
    run->flow.wants_pressures = snapshot_is_due(run);
    if (run->flow.wants_pressures) viscous_events_forget(run->events);
    const enum status status = viscous_events_find(run->events, reason);
    if (!status) keep_pressures(run);
    return status;
}

static enum status happen(struct run *run, struct viscous_event event,
                          struct reason *reason)
{
    recorder_add_event(&run->recorder, compensated_value(run->time) * run->scale.time,
                       event.throat, event.refills ? EVENT_REFILLED : EVENT_EMPTIED);
    const enum status status = viscous_events_happen(run->events, event, reason);
    note_breakthrough(run);
    return status ? status : check_vapour(run, reason);
}

enum status drying_step_kept_flow(struct run *run, struct reason *reason)
{
    const int n_before = run->occupancy.n_liquid;
    enum status status = find_losses(run, reason);
    if (status) return status;
    const struct viscous_event event = viscous_events_next(run->events);
    if (event.throat < 0) return refuse_standstill(run, reason);
    const double rate = viscous_events_rate(run->events);
    const double span = fmin(event.span, left_to_stop(run) / rate);
    if (last_step_but_one_is_due(run, rate * span)) record_step(run);
    compensated_add(&run->time, viscous_events_advance(run->events, span));
    compensated_add(&run->evaporated, rate * span);
    if (span == event.span) status = happen(run, event, reason);
    if (status) return status;
    run->n_flow_step++;
    if (step_is_due(run)) record_step(run);
    return note_idle(run, run->occupancy.n_liquid == n_before, reason);
}
