// SPDX-License-Identifier: GPL-3.0-or-later
// The run itself [K 3.4.2]: vapour, losses, the throat that empties first, and again.
#include "drying.h"

#include "basics/compensated.h"
#include "basics/memory.h"
#include "boundary_layer.h"
#include "clocks.h"
#include "conditions.h"
#include "history.h"
#include "losses.h"
#include "phases.h"

#include <stdlib.h>

// Throats that have this part of their volume left, or less, when another empties would
// have emptied with it but for rounding.
static const double TIE = 1e-12;

struct run {
    const struct drying_conditions *conditions;
    struct drying_scale scale;
    struct phases phases;
    struct clocks clocks;    // empty if the liquid is viscous
    struct losses losses;    // empty unless it is
    struct liquid_flow flow; // empty unless it is
    int n_idle;              // viscous: steps since a throat has emptied
    struct recorder recorder;
    struct compensated time, evaporated; // scaled
    double imbalance;                    // largest at a step

    // Since the last step was recorded.
    double step_saturation;
    struct compensated step_time, step_evaporated;
    int n_skipped;      // events
    int n_ended;        // throats that have emptied
    int *ended;         // (n_ended)
    double *saturation; // (n_throat) at that step
};

int impose_empty_throats(struct network *network, unsigned walls)
{
    int n = 0;
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *node = network->throat_nodes[t];
        if (network->throat_kind[t] == THROAT_NETWORK &&
            network->node_walls[node[0]] & network->node_walls[node[1]] & walls)
            network->throat_kind[t] = THROAT_IMPOSED_EMPTY;
        n += network->throat_kind[t] == THROAT_IMPOSED_EMPTY;
    }
    return n;
}

static double network_saturation(const struct run *run)
{
    if (run->phases.n_full == 0) return 0;
    const double liquid = compensated_value(run->phases.total_liquid);
    return fmin(1, fmax(0, liquid / run->phases.initial_liquid));
}

static double rate_now(const struct run *run)
{
    return run->phases.n_full > 0 ? vapour_rate(&run->phases.vapour) : 0;
}

static void record_state(struct run *run)
{
    const double rate = rate_now(run);
    recorder_add_step(&run->recorder, compensated_value(run->time) * run->scale.time,
                      network_saturation(run), rate * run->scale.rate,
                      run->phases.clusters.count);
}

static void note_breakthrough(struct run *run)
{
    struct drying_history *history = run->recorder.history;
    if (run->phases.breakthrough && history->breakthrough_saturation == 0)
        history->breakthrough_saturation = network_saturation(run);
}

// --- clocks: liquid without viscosity, or immobile ---------------------------------

static void record_change(struct run *run, int throat)
{
    const double saturation = clocks_saturation(&run->clocks, throat);
    if (!(saturation < run->saturation[throat])) return; // too little to show
    recorder_add_change(&run->recorder, throat, saturation);
    run->saturation[throat] = saturation;
}

static int compare_throats(const void *a, const void *b)
{
    const int *t = a, *s = b;
    return (*t > *s) - (*t < *s);
}

// Of all throats that lose or have lost since the last step, in ascending order.
static void record_changes(struct run *run)
{
    const struct clocks *clocks = &run->clocks;
    qsort(run->ended, (size_t)run->n_ended, sizeof *run->ended, compare_throats);
    int k = 0;
    for (int l = 0; l < clocks->n; l++) {
        for (; k < run->n_ended && run->ended[k] < clocks->losing[l]; k++)
            record_change(run, run->ended[k]);
        record_change(run, clocks->losing[l]);
    }
    for (; k < run->n_ended; k++)
        record_change(run, run->ended[k]);
    run->n_ended = 0;
}

// A step if it is time for one. Where events were passed over, the rate of the last
// step becomes the mean until this.
static void record_step(struct run *run)
{
    const double saturation = network_saturation(run);
    const double fallen = run->step_saturation - saturation;
    if (fallen < run->conditions->step_interval && run->phases.n_full > 0) {
        run->n_skipped++;
        return;
    }
    if (run->n_skipped > 0) {
        const double evaporated =
            compensated_difference(run->evaporated, run->step_evaporated);
        const double time = compensated_difference(run->time, run->step_time);
        recorder_set_last_rate(&run->recorder, evaporated / time * run->scale.rate);
    }
    record_changes(run);
    record_state(run);
    run->imbalance = fmax(run->imbalance, fabs(clocks_imbalance(&run->clocks)));
    run->n_skipped = 0;
    run->step_saturation = saturation;
    run->step_time = run->time;
    run->step_evaporated = run->evaporated;
}

static enum status dry_to_next_end(struct run *run, struct reason *reason)
{
    struct clocks *clocks = &run->clocks;
    const double rate = rate_now(run);
    const double duration = clocks_advance(clocks);
    if (duration < 0)
        return refuse(
            reason, STATUS_NOT_CONVERGED,
            "nothing evaporates any more with %d throats still wet (rates too "
            "small for the arithmetic)",
            run->phases.n_full);
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

// --- steps: viscous liquid ---------------------------------------------------------

// When the first throat has emptied or filled, or changed by saturation_step.
static double time_to_first(const struct run *run)
{
    double shortest = INFINITY;
    for (int k = 0; k < run->losses.n; k++) {
        const struct loss *loss = &run->losses.loss[k];
        const double volume = run->phases.volume[loss->throat];
        const double left = compensated_value(run->phases.liquid[loss->throat]);
        shortest = fmin(shortest, loss->rate > 0 ? left / loss->rate
                                                 : (volume - left) / -loss->rate);
        if (run->conditions->liquid == LIQUID_VISCOUS)
            shortest = fmin(shortest, run->conditions->saturation_step * volume /
                                          fabs(loss->rate));
    }
    return shortest;
}

// THROAT loses AMOUNT, or all it has if that is all but TIE of its volume: then it ties
// with the first. Likewise one that fills.
static void lose(struct phases *phases, int throat, double amount)
{
    struct compensated *liquid = &phases->liquid[throat];
    const double before = compensated_value(*liquid);
    const double volume = phases->volume[throat];
    if (amount < 0 && before - amount > volume * (1 - TIE)) {
        *liquid = (struct compensated){.value = volume};
        compensated_add(&phases->total_liquid, volume - before);
    } else if (before - amount > TIE * volume) {
        compensated_add(liquid, -amount);
        compensated_add(&phases->total_liquid, -amount);
    } else {
        *liquid = (struct compensated){0};
        compensated_add(&phases->total_liquid, -before);
    }
}

static double throat_saturation(const struct phases *phases, int throat)
{
    return compensated_value(phases->liquid[throat]) / phases->volume[throat];
}

// Time passes until the first throat has emptied.
static void advance(struct run *run, double duration)
{
    struct phases *phases = &run->phases;
    compensated_add(&run->time, duration);
    compensated_add(&run->evaporated, vapour_rate(&phases->vapour) * duration);
    for (int k = 0; k < run->losses.n; k++) {
        const struct loss *loss = &run->losses.loss[k];
        const double before = throat_saturation(phases, loss->throat);
        lose(phases, loss->throat, loss->rate * duration);
        const double after = throat_saturation(phases, loss->throat);
        if (after != before) // too little to show, now and then
            recorder_add_change(&run->recorder, loss->throat, after);
    }
}

static void note_refills(struct run *run, double time)
{
    const struct phases *phases = &run->phases;
    for (int k = 0; k < run->losses.n; k++) {
        const struct loss *loss = &run->losses.loss[k];
        if (loss->rate < 0 && throat_saturation(phases, loss->throat) == 1)
            recorder_add_event(&run->recorder, time, loss->throat, EVENT_REFILLED);
    }
}

// Gas fills what has emptied [K 3.4.2, step 6].
static void empty_throats(struct run *run)
{
    struct phases *phases = &run->phases;
    const double time = compensated_value(run->time) * run->scale.time;
    note_refills(run, time);
    for (int k = 0; k < run->losses.n; k++) {
        const int throat = run->losses.loss[k].throat;
        if (phases->liquid[throat].value != 0) continue;
        phases_empty_throat(phases, throat);
        recorder_add_event(&run->recorder, time, throat, EVENT_EMPTIED);
    }
    note_breakthrough(run);
}

static bool snapshot_is_due(const struct run *run)
{
    const int next = run->recorder.history->n_pressure;
    return next < run->conditions->n_snapshot &&
           network_saturation(run) <= run->conditions->snapshot[next];
}

static void keep_pressures(struct run *run)
{
    struct drying_history *history = run->recorder.history;
    const size_t n = (size_t)run->phases.network->n_node;
    if (!history->pressure)
        history->pressure = NEW_ARRAY(double, n *(size_t)run->conditions->n_snapshot);
    double *pressure = history->pressure + n * (size_t)history->n_pressure++;
    for (size_t i = 0; i < n; i++)
        pressure[i] = run->flow.pressure[i] * run->flow.menisci.pressure;
}

// Throats may refill in turn, but not for ever.
static enum status note_idle(struct run *run, bool idle, struct reason *reason)
{
    run->n_idle = idle ? run->n_idle + 1 : 0;
    const double most =
        100.0 * (run->phases.n_full + 10) / run->conditions->saturation_step;
    if (run->n_idle < most) return STATUS_OK;
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "throats refilled %d times over, and none has emptied, with %d still "
                  "wet (a smaller saturation_step may help)",
                  run->n_idle, run->phases.n_full);
}

static enum status dry_step(struct run *run, struct reason *reason)
{
    struct phases *phases = &run->phases;
    run->flow.wants_pressures = snapshot_is_due(run);
    enum status status = losses_find(&run->losses, phases, &run->flow, reason);
    if (status) return status;
    while (snapshot_is_due(run))
        keep_pressures(run);
    if (run->losses.n == 0)
        return refuse(
            reason, STATUS_NOT_CONVERGED,
            "nothing evaporates any more with %d throats still wet (rates too "
            "small for the arithmetic)",
            phases->n_full);
    advance(run, time_to_first(run));
    const int n_before = phases->n_full;
    empty_throats(run);
    record_state(run);
    return note_idle(run, phases->n_full == n_before, reason);
}

// --- the whole run -----------------------------------------------------------------

static void note_first_period(struct run *run, double first_rate)
{
    struct drying_history *history = run->recorder.history;
    const double fraction = run->conditions->first_period_rate_fraction;
    if (history->first_period_end_saturation == 0 &&
        rate_now(run) < fraction * first_rate)
        history->first_period_end_saturation = network_saturation(run);
}

static enum status dry_all(struct run *run, const struct drying_progress *progress,
                           struct reason *reason)
{
    const int n = run->phases.n_full;
    const double first_rate = rate_now(run);
    enum status status = STATUS_OK;
    record_state(run);
    while (!status && run->phases.n_full > 0) {
        status = run->conditions->liquid == LIQUID_VISCOUS
                     ? dry_step(run, reason)
                     : dry_to_next_end(run, reason);
        note_first_period(run, first_rate);
        if (progress && progress->report)
            progress->report(progress->context, 1 - (double)run->phases.n_full / n);
    }
    return status;
}

static void summarise(const struct run *run, struct drying_history *history)
{
    history->boundary_layer_thickness = run->scale.boundary_layer * run->scale.length;
    history->boundary_layers = run->phases.layer.layers;
    history->initial_liquid = run->phases.initial_liquid * run->scale.mass;
    history->evaporated = compensated_value(run->evaporated) * run->scale.mass;
    history->vapour_residual = run->imbalance;
    history->liquid_residual = run->flow.residual;
    history->flow_solutions = run->flow.solutions;
    history->flow_rounds = run->flow.rounds;
}

// What the liquid needs.
static void prepare(struct run *run)
{
    const struct network *network = run->phases.network;
    if (run->conditions->liquid == LIQUID_VISCOUS) {
        run->flow =
            liquid_flow_make(network, run->scale.length,
                             menisci_make(network, run->conditions, &run->scale));
        run->losses = losses_make(network->n_throat);
        return;
    }
    run->clocks = clocks_make(&run->phases, run->conditions->liquid == LIQUID_IMMOBILE);
    run->step_saturation = 1;
    run->ended = NEW_ARRAY(int, network->n_throat);
    run->saturation = NEW_ARRAY(double, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        run->saturation[t] = 1;
}

// How easily gas enters each throat against gravity. The caller frees it.
static double *find_ease(const struct network *network,
                         const struct drying_conditions *conditions,
                         const struct drying_scale *scale)
{
    struct menisci menisci = menisci_make(network, conditions, scale);
    double *ease = NEW_ARRAY(double, network->n_throat);
    menisci_ease(&menisci, ease);
    menisci_free(&menisci);
    return ease;
}

enum status dry_network(const struct network *network,
                        const struct drying_conditions *conditions,
                        const struct drying_progress *progress,
                        struct drying_history *history, struct reason *reason)
{
    *history = (struct drying_history){0};
    enum status status = check_conditions(conditions, reason);
    if (!status) status = check_gravity(conditions, network, reason);
    if (!status) status = check_throats(network, reason);
    if (status) return status;

    struct run run = {.conditions = conditions,
                      .scale = drying_scale(network, conditions),
                      .recorder = recorder_make(history)};
    const int wall = open_wall(conditions);
    struct boundary_layer layer;
    status = boundary_layer_make(
        network, wall, run.scale.length, run.scale.boundary_layer,
        &(struct boundary_form){conditions->feet, conditions->layers,
                                conditions->lumped},
        &layer, reason);
    if (status) {
        boundary_layer_free(&layer);
        return status;
    }

    double *ease = conditions->gravity != 0 ? find_ease(network, conditions, &run.scale)
                                            : NULL; // by radius
    const struct phases_form form = {.length = run.scale.length,
                                     .gas_parts = conditions->liquid != LIQUID_IMMOBILE,
                                     .ease = ease,
                                     .knudsen_radius = knudsen_radius(conditions)};
    status = phases_make(network, wall, &form, layer, &run.phases, reason);
    free(ease);
    if (!status) {
        prepare(&run);
        status = dry_all(&run, progress, reason);
    }
    if (!status) summarise(&run, history);
    liquid_flow_free(&run.flow);
    losses_free(&run.losses);
    clocks_free(&run.clocks);
    free(run.ended);
    free(run.saturation);
    phases_free(&run.phases);
    return status;
}
