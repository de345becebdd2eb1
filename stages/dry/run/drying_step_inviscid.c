// SPDX-License-Identifier: GPL-3.0-or-later
// Liquid without viscosity, or immobile: advances to the moment at which the next
// throat has emptied [K 3.4.2, steps 5 and 6]. Of the throats that lose, only the
// saturations that differ from the last recorded step are written, in ascending order:
// the losing throats and those that have emptied are merged as two sorted lists.
//
// In this order: the rate of now; `duration` to the first timer that ends; time and
// evaporated mass; events of all throats that end together; gas fills these, which
// changes rates and clusters; breakthrough; the record (rings as n_throat + node). The
// rate must be read before gas fills anything, as it is that of the interval that ends
// here.
#include "dry/inviscid/film_supply.h"
#include "film_history.h"
#include "run.h"

#include <math.h>

static void record_change(struct run *run, int throat)
{
    const double saturation = emptying_times_saturation(&run->times, throat);
    if (!(saturation < run->saturation[throat])) return; // too little to show
    recorder_add_change(&run->recorder, throat, saturation);
    run->saturation[throat] = saturation;
}

// Records all throats that lose or have lost since the last step, in ascending order.
static void record_changes(struct run *run)
{
    const struct emptying_times *times = &run->times;
    sort_ended(run);
    int k = 0;
    for (int l = 0; l < times->n_losing; l++) {
        for (; k < run->n_ended && run->ended[k] < times->losing[l]; k++)
            record_change(run, run->ended[k]);
        record_change(run, times->losing[l]);
    }
    for (; k < run->n_ended; k++)
        record_change(run, run->ended[k]);
    run->n_ended = 0;
}

// The imbalance is looked at where steps are recorded only: it costs a sum over all.
static void record_step(struct run *run)
{
    record_changes(run);
    record_state(run);
    run->imbalance = fmax(run->imbalance, fabs(emptying_times_imbalance(&run->times)));
}

static enum status refuse_films(const struct run *run, struct reason *reason)
{
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "rings=films: the flow in films was not found to 1e-6 of the drying "
                  "rate at saturation %g",
                  network_saturation(run));
}

enum status drying_step_inviscid(struct run *run, struct reason *reason)
{
    struct emptying_times *times = &run->times;
    if (run->conditions->stop_saturation > 0 &&
        last_step_but_one_is_due(run, emptying_times_next_loss(times)))
        record_step(run);
    const double rate = rate_now(run);
    const double by_films = times->films ? times->films->evaporation : 0;
    const double pace = vapour_pace(&run->occupancy.vapour);
    const double duration = emptying_times_advance(times) / pace;
    if (duration < 0) return refuse_standstill(run, reason);
    compensated_add(&run->time, duration);
    compensated_add(&run->evaporated, rate * duration);
    if (run->recorder.history->films)
        run->recorder.history->films->evaporated +=
            by_films * duration * run->scale.mass;
    const double time = compensated_value(run->time) * run->scale.time;
    for (int k = 0; k < times->n_ended; k++) {
        if (times->ended[k] < run->occupancy.network->n_throat)
            recorder_add_event(&run->recorder, time, times->ended[k], EVENT_EMPTIED);
        run->ended[run->n_ended++] = times->ended[k];
    }
    emptying_times_empty_ended(times);
    const enum status status = check_vapour(run, reason);
    if (status) return status;
    if (times->films && times->films->failed) return refuse_films(run, reason);
    note_breakthrough(run);
    if (step_is_due(run)) record_step(run);
    return STATUS_OK;
}
