// SPDX-License-Identifier: GPL-3.0-or-later
#include "resume.h"

#include "basics/memory.h"
#include "check_state.h"

#include <limits.h>

// A factorisation costs as much as some ten steps.
enum { STEPS_BETWEEN_CUTS = 256 };

static void pressures_state(struct run *run, struct state *state)
{
    struct drying_history *history = run->recorder.history;
    state_integer(state, &history->n_pressure, 0, run->conditions->n_snapshot);
    const int64_t n_node = run->phases.network->n_node;
    if (state->restoring && history->n_pressure > 0)
        history->pressure =
            NEW_ARRAY(double, n_node *(int64_t)run->conditions->n_snapshot);
    state_numbers(state, history->pressure, n_node * history->n_pressure);
}

static void flow_state(struct run *run, struct state *state)
{
    struct liquid_flow *flow = &run->flow;
    state_flags(state, flow->moving, run->phases.network->n_throat);
    state_numbers(state, &flow->residual, 1);
    state_long(state, &flow->rounds);
    state_long(state, &flow->solutions);
    pressures_state(run, state);
}

static void steps_state(struct run *run, struct state *state)
{
    const int n_throat = run->phases.network->n_throat;
    state_numbers(state, &run->step_saturation, 1);
    state_sums(state, &run->step_time, 1);
    state_sums(state, &run->step_evaporated, 1);
    state_integer(state, &run->n_skipped, 0, INT_MAX);
    state_integer(state, &run->n_ended, 0, n_throat);
    state_integers(state, run->ended, run->n_ended, 0, n_throat - 1);
    state_flags(state, run->is_ended, n_throat);
    state_integer(state, &run->n_idle, 0, INT_MAX);
    state_numbers(state, run->saturation, n_throat);
}

// Of menisci with vapour pressures of their own they are found before the state is
// kept.
static void losses_state(struct losses *losses, int n_throat, struct state *state)
{
    state_integer(state, &losses->n, 0, n_throat);
    for (int k = 0; k < losses->n; k++) {
        state_integer(state, &losses->loss[k].throat, 0, n_throat - 1);
        state_numbers(state, &losses->loss[k].rate, 1);
    }
}

static void run_state(struct run *run, struct state *state)
{
    state_sums(state, &run->time, 1);
    state_sums(state, &run->evaporated, 1);
    state_numbers(state, &run->imbalance, 1);
    state_numbers(state, &run->first_rate, 1);
    state_integer(state, &run->n_at_start, 0, run->phases.network->n_throat);
    state_long(state, &run->n_flow_step);
    recorder_state(&run->recorder, run->phases.network->n_throat, state);
    phases_state(&run->phases, state);
    steps_state(run, state);
    const int n_throat = run->phases.network->n_throat;
    const bool is_viscous = run->conditions->liquid == LIQUID_VISCOUS;
    if (run->conditions->kelvin) {
        curved_state(&run->curved, run->phases.network, state);
        losses_state(&run->losses, n_throat, state);
    }
    if (is_viscous) flow_state(run, state);
    if (is_viscous && run->conditions->kelvin) curved_flow_state(&run->both, state);
    if (!is_viscous && !run->conditions->kelvin) clocks_state(&run->clocks, state);
}

static const char streams[] = "drying";

// Clocks are cut anywhere.
void keep_if_due(struct run *run, const struct keeper *keeper)
{
    if (run->n_flow_step % STEPS_BETWEEN_CUTS != 0) return;
    if (run->conditions->liquid == LIQUID_VISCOUS)
        liquid_flow_forget(&run->flow, &run->phases);
    if (run->conditions->kelvin) curved_forget(&run->curved);
    if (!is_due(keeper)) return;
    struct state state = state_to_keep();
    run_state(run, &state);
    struct kept_state kept = {.stage = state_list(&state, streams)};
    state_free(&state);
    keeper->keep(keeper->context, &kept);
    free_kept_state(&kept);
}

enum status go_on_from(struct run *run, const struct kept_state *kept,
                       struct reason *reason)
{
    struct state state = state_to_restore(&kept->stage, streams);
    run_state(run, &state);
    if (!state_is_whole(&state) || !run_fits(run))
        return refuse(reason, STATUS_BAD_DATA,
                      "/stage: is not the state of a drying of this network");
    if (run->conditions->liquid == LIQUID_VISCOUS)
        liquid_flow_forget(&run->flow, &run->phases);
    return STATUS_OK;
}
