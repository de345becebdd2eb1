// SPDX-License-Identifier: GPL-3.0-or-later
// The run itself [K 3.4.2]: vapour, losses, the throat that empties first, and again.
#include "drying.h"

#include "boundary_layer.h"
#include "compensated.h"
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
    struct losses losses;
    struct liquid_flow flow; // empty unless the liquid is viscous
    struct recorder recorder;
    struct compensated time, evaporated; // scaled
};

int impose_empty_throats(struct network *network, unsigned walls)
{
    int n = 0;
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *node = network->throat_nodes[t];
        if (network->node_walls[node[0]] & network->node_walls[node[1]] & walls)
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

static void record_state(struct run *run)
{
    const double rate = run->phases.n_full > 0 ? vapour_rate(&run->phases.vapour) : 0;
    recorder_add_step(&run->recorder, compensated_value(run->time) * run->scale.time,
                      network_saturation(run), rate * run->scale.rate,
                      run->phases.clusters.count);
}

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
    const bool breakthrough_before = phases->breakthrough;
    const double time = compensated_value(run->time) * run->scale.time;
    note_refills(run, time);
    for (int k = 0; k < run->losses.n; k++) {
        const int throat = run->losses.loss[k].throat;
        if (phases->liquid[throat].value != 0) continue;
        phases_empty_throat(phases, throat);
        recorder_add_event(&run->recorder, time, throat, EVENT_EMPTIED);
    }
    if (phases->breakthrough && !breakthrough_before)
        run->recorder.history->breakthrough_saturation = network_saturation(run);
}

static enum status dry_step(struct run *run, struct reason *reason)
{
    struct phases *phases = &run->phases;
    enum status status =
        losses_find(&run->losses, phases, run->conditions->liquid, &run->flow, reason);
    if (status) return status;
    if (run->losses.n == 0)
        return refuse(
            reason, STATUS_NOT_CONVERGED,
            "nothing evaporates any more with %d throats still wet (rates too "
            "small for the arithmetic)",
            phases->n_full);
    advance(run, time_to_first(run));
    empty_throats(run);
    status = vapour_check(&phases->vapour, reason);
    record_state(run);
    return status;
}

static enum status dry_all(struct run *run, const struct drying_progress *progress,
                           struct reason *reason)
{
    const int n = run->phases.n_full;
    enum status status = STATUS_OK;
    record_state(run);
    while (!status && run->phases.n_full > 0) {
        status = dry_step(run, reason);
        if (progress && progress->report)
            progress->report(progress->context, 1 - (double)run->phases.n_full / n);
    }
    return status;
}

static void summarise(const struct run *run, struct drying_history *history)
{
    const double fraction = run->conditions->first_period_rate_fraction;
    for (int k = 0; k < history->n_step; k++)
        if (history->rate[k] < fraction * history->rate[0]) {
            history->first_period_end_saturation = history->saturation[k];
            break;
        }
    history->boundary_layer_thickness = run->scale.boundary_layer * run->scale.length;
    history->boundary_layers = run->phases.layer.layers;
    history->initial_liquid = run->phases.initial_liquid * run->scale.mass;
    history->evaporated = compensated_value(run->evaporated) * run->scale.mass;
    history->vapour_residual = run->phases.vapour.residual;
    history->liquid_residual = run->flow.residual;
    history->flow_solutions = run->flow.solutions;
    history->flow_rounds = run->flow.rounds;
}

enum status dry_network(const struct network *network,
                        const struct drying_conditions *conditions,
                        const struct drying_progress *progress,
                        struct drying_history *history, struct reason *reason)
{
    *history = (struct drying_history){0};
    enum status status = check_conditions(conditions, reason);
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

    const bool gas_parts = conditions->liquid != LIQUID_IMMOBILE;
    if (conditions->liquid == LIQUID_VISCOUS)
        run.flow = liquid_flow_make(network, run.scale.length,
                                    menisci_make(network, conditions, &run.scale));
    run.losses = losses_make(network->n_throat);
    status = phases_make(network, wall, run.scale.length, gas_parts, layer, &run.phases,
                         reason);
    if (!status) status = dry_all(&run, progress, reason);
    if (!status) summarise(&run, history);
    liquid_flow_free(&run.flow);
    losses_free(&run.losses);
    phases_free(&run.phases);
    return status;
}
