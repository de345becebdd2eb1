// SPDX-License-Identifier: GPL-3.0-or-later
// One visitor, run_state, both keeps and restores, so that the two cannot differ. What
// is kept only for speed (factors, graphs) is not in the state: it is forgotten every
// steps_between_cuts steps, in runs with and without checkpoints alike, so that a run
// that continues makes the same bytes.
//
// Order: time and sums, the history, occupancy (with vapour and clusters), what has
// happened since the last recorded step, then what the kind of liquid needs (menisci
// and their losses, flow and its pressures, both together, or timers). Values have no
// names, so a count comes before the array whose length it is. Which parts there are
// follows from conditions, and these are the same in both runs: the restart artifact
// is refused for other parameters or inputs.
//
// Trap: a member that a step changes and that is missing here would let a continued run
// drift from one in one piece without a message.
#include "resume.h"

#include "basics/memory.h"
#include "check_state.h"
#include "dry/inviscid/film_supply.h"
#include "film_history.h"

#include <limits.h>

// Forgetting costs a flow in each cluster from scratch, as much as some ten steps;
// where flows are kept, as some hundred, 1 to 3 % of the time so.
static int steps_between_cuts(const struct run *run)
{
    return run->conditions->flow_step > 0 ? 1024 : 256;
}

// Rows of snapshots that are still to come are not kept. While restoring, room is made
// for all of them, as keep_pressures does at the first.
static void pressures_state(struct run *run, struct checkpoint_stream *stream)
{
    struct drying_history *history = run->recorder.history;
    stream_integer(stream, &history->n_pressure, 0, run->conditions->n_snapshot);
    const int64_t n_node = run->occupancy.network->n_node;
    if (stream->restoring && history->n_pressure > 0)
        history->pressure =
            NEW_ARRAY(double, n_node *(int64_t)run->conditions->n_snapshot);
    stream_numbers(stream, history->pressure, n_node * history->n_pressure);
}

static void flow_state(struct run *run, struct checkpoint_stream *stream)
{
    struct liquid_flow *flow = &run->flow;
    stream_flags(stream, flow->moving, run->occupancy.network->n_throat);
    if (run->events) stream_numbers(stream, &run->events->pace, 1);
    stream_numbers(stream, &flow->residual, 1);
    stream_long(stream, &flow->rounds);
    stream_long(stream, &flow->solutions);
    pressures_state(run, stream);
}

static void steps_state(struct run *run, struct checkpoint_stream *stream)
{
    const int n = n_place_of(&run->occupancy);
    stream_numbers(stream, &run->step_saturation, 1);
    stream_sums(stream, &run->step_time, 1);
    stream_sums(stream, &run->step_evaporated, 1);
    stream_integer(stream, &run->n_skipped, 0, INT_MAX);
    stream_integer(stream, &run->n_ended, 0, n);
    stream_integers(stream, run->ended, run->n_ended, 0, n - 1);
    stream_flags(stream, run->is_ended, n);
    stream_integer(stream, &run->n_idle, 0, INT_MAX);
    stream_numbers(stream, run->saturation, n);
}

// Kelvin effect: the losses of the next step have been found before the state is kept.
static void losses_state(struct losses *losses, int n_throat,
                         struct checkpoint_stream *stream)
{
    stream_integer(stream, &losses->n, 0, n_throat);
    for (int k = 0; k < losses->n; k++) {
        stream_integer(stream, &losses->loss[k].throat, 0, n_throat - 1);
        stream_numbers(stream, &losses->loss[k].rate, 1);
    }
}

static void run_state(struct run *run, struct checkpoint_stream *stream)
{
    stream_sums(stream, &run->time, 1);
    stream_sums(stream, &run->evaporated, 1);
    stream_numbers(stream, &run->imbalance, 1);
    stream_numbers(stream, &run->first_rate, 1);
    stream_integer(stream, &run->n_at_start, 0, n_place_of(&run->occupancy));
    stream_long(stream, &run->n_flow_step);
    recorder_state(&run->recorder, run->occupancy.network->n_throat,
                   n_place_of(&run->occupancy), stream);
    occupancy_state(&run->occupancy, stream);
    steps_state(run, stream);
    const int n_throat = run->occupancy.network->n_throat;
    const bool is_viscous = run->conditions->liquid == LIQUID_VISCOUS;
    if (run->conditions->kelvin) {
        kelvin_menisci_state(&run->kelvin, run->occupancy.network, stream);
        losses_state(&run->losses, n_throat, stream);
    }
    if (run->recorder.history->films)
        film_history_state(run->recorder.history->films, stream);
    if (is_viscous) flow_state(run, stream);
    if (is_viscous && run->conditions->kelvin)
        kelvin_viscous_state(&run->coupling, stream);
    if (!is_viscous && !run->conditions->kelvin)
        emptying_times_state(&run->times, stream);
}

static const char streams[] = "drying"; // prefix of the arrays in the artifact

// Whether this is a moment at which flows are forgotten: where vapour is kept, as it
// has been found with the last use of a factor.
static bool is_cut(const struct run *run)
{
    if (run->events && run->occupancy.vapour.kept) return run->events->found_vapour;
    return run->n_flow_step % steps_between_cuts(run) == 0;
}

// Runs with timers forget nothing and can be kept after any step (n_flow_step stays 0),
// but those with films or kept vapour only where these have forgotten.
void keep_if_due(struct run *run, const struct keeper *keeper)
{
    const struct film_supply *films = run->times.films;
    if (films && !film_supply_may_be_kept(films)) return;
    const struct kept_vapour *vapour = run->occupancy.vapour.kept;
    if (vapour && !kept_vapour_may_be_kept(vapour)) return;
    if (!is_cut(run)) return;
    if (run->events) viscous_events_forget(run->events);
    if (run->conditions->liquid == LIQUID_VISCOUS)
        liquid_flow_forget(&run->flow, &run->occupancy);
    if (run->conditions->kelvin) kelvin_menisci_forget(&run->kelvin);
    if (!is_due(keeper)) return;
    struct checkpoint_stream stream = stream_to_keep();
    run_state(run, &stream);
    struct kept_state kept = {.stage = stream_list(&stream, streams)};
    stream_free(&stream);
    keeper->keep(keeper->context, &kept);
    free_kept_state(&kept);
}

// Whole and consistent, or refused: a state is trusted only after both checks. The flow
// then starts from scratch, as it does after each cut in the run that kept it.
enum status go_on_from(struct run *run, const struct kept_state *kept,
                       struct reason *reason)
{
    struct checkpoint_stream stream = stream_to_restore(&kept->stage, streams);
    run_state(run, &stream);
    if (!stream_is_whole(&stream) || !run_fits(run))
        return refuse(reason, STATUS_BAD_DATA,
                      "/stage: is not the state of a drying of this network");
    if (run->conditions->liquid == LIQUID_VISCOUS)
        liquid_flow_forget(&run->flow, &run->occupancy);
    return STATUS_OK;
}
