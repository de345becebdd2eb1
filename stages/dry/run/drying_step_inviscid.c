// SPDX-License-Identifier: GPL-3.0-or-later
// Liquid without viscosity, or immobile: on to the moment at which the next throat has
// emptied.
#include "run.h"

#include <math.h>

static void record_change(struct run *run, int throat)
{
    const double saturation = clocks_saturation(&run->clocks, throat);
    if (!(saturation < run->saturation[throat])) return; // too little to show
    recorder_add_change(&run->recorder, throat, saturation);
    run->saturation[throat] = saturation;
}

// Of all throats that lose or have lost since the last step, in ascending order.
static void record_changes(struct run *run)
{
    const struct clocks *clocks = &run->clocks;
    sort_ended(run);
    int k = 0;
    for (int l = 0; l < clocks->n_losing; l++) {
        for (; k < run->n_ended && run->ended[k] < clocks->losing[l]; k++)
            record_change(run, run->ended[k]);
        record_change(run, clocks->losing[l]);
    }
    for (; k < run->n_ended; k++)
        record_change(run, run->ended[k]);
    run->n_ended = 0;
}

static void record_step(struct run *run)
{
    if (!step_is_due(run)) return;
    record_changes(run);
    record_state(run);
    run->imbalance = fmax(run->imbalance, fabs(clocks_imbalance(&run->clocks)));
}

enum status dry_by_clocks(struct run *run, struct reason *reason)
{
    struct clocks *clocks = &run->clocks;
    const double rate = rate_now(run);
    const double duration = clocks_advance(clocks);
    if (duration < 0) return refuse_standstill(run, reason);
    compensated_add(&run->time, duration);
    compensated_add(&run->evaporated, rate * duration);
    const double time = compensated_value(run->time) * run->scale.time;
    for (int k = 0; k < clocks->n_ended; k++) {
        recorder_add_event(&run->recorder, time, clocks->ended[k], EVENT_EMPTIED);
        run->ended[run->n_ended++] = clocks->ended[k];
    }
    clocks_empty_ended(clocks);
    note_breakthrough(run);
    record_step(run);
    return STATUS_OK;
}
