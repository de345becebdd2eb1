// SPDX-License-Identifier: GPL-3.0-or-later
// The run, from event to event [K 3.4.2]. An event is the moment at which the next
// throat has emptied (or, in viscous liquid, filled or changed by saturation_step):
//     rates from the vapour -> loss of each throat -> time to the first event
//     -> gas fills what has emptied -> rates ...
// Four kinds of step do this: event times (inviscid, immobile), flow (viscous), flow
// that is kept, and menisci with the Kelvin effect. All start from the same occupancy,
// record through the same recorder and end at stop_saturation, where truncate_history
// cuts the last step.
#include "drying.h"

#include "basics/memory.h"
#include "dry/gas/boundary_layer.h"
#include "dry/inviscid/film_supply.h"
#include "film_history.h"
#include "initial_saturation.h"
#include "network/checks.h"
#include "resume.h"
#include "ring_history.h"
#include "run.h"
#include "truncate_history.h"

#include <math.h>
#include <stdlib.h>

// The first moment at which the rate is below this share of the first one; written
// once.
static void note_first_period(struct run *run)
{
    struct drying_history *history = run->recorder.history;
    const double fraction = run->conditions->first_period_rate_fraction;
    if (history->first_period_end_time > 0 ||
        !(rate_now(run) < fraction * run->first_rate))
        return;
    history->first_period_end_saturation = network_saturation(run);
    history->first_period_end_time = compensated_value(run->time) * run->scale.time;
}

static void begin(struct run *run)
{
    run->n_at_start = run->occupancy.n_liquid;
    run->first_rate = rate_now(run);
    note_breakthrough(run);
    record_state(run);
}

// Kelvin first: it has a step of its own for each kind of liquid.
static enum status take_step(struct run *run, struct reason *reason)
{
    if (run->conditions->kelvin) return drying_step_kelvin(run, reason);
    if (run->events) return drying_step_kept_flow(run, reason);
    if (run->conditions->liquid == LIQUID_VISCOUS)
        return drying_step_viscous(run, reason);
    return drying_step_inviscid(run, reason);
}

static enum status dry_all(struct run *run, const struct drying_progress *progress,
                           struct reason *reason)
{
    enum status status = STATUS_OK;
    while (!status && goes_on(run)) {
        status = take_step(run, reason);
        note_first_period(run);
        if (progress && progress->report)
            progress->report(progress->context,
                             1 - (double)run->occupancy.n_liquid / run->n_at_start);
        if (!status) keep_if_due(run, progress ? progress->keeper : NULL);
    }
    return status ? status : keep_last_pressures(run, reason);
}

// From scaled to SI. The history is cut last, as it may end within a step.
static void summarise(const struct run *run, struct drying_history *history)
{
    history->boundary_layer_thickness = run->scale.boundary_layer * run->scale.length;
    history->boundary_layers = run->occupancy.layer.layers;
    history->initial_liquid = run->occupancy.initial_liquid * run->scale.mass;
    history->evaporated = compensated_value(run->evaporated) * run->scale.mass;
    history->vapour_residual = fmax(run->imbalance, run->kelvin.residual);
    history->liquid_residual = run->flow.residual;
    history->flow_solutions = run->flow.solutions;
    history->flow_rounds = run->flow.rounds;
    if (history->films && run->times.films)
        history->films->solutions = run->times.films->solutions;
    if (run->conditions->stop_saturation > 0)
        truncate_history(history, run->occupancy.network,
                         run->conditions->stop_saturation);
    if (run->conditions->rings)
        ring_history_take(history, run->occupancy.network, &run->rings,
                          run->scale.length);
}

// Removes the liquid that is missing at the start, and records it as step 0's changes.
// Throats that begin full are not listed: full is what a reader assumes.
static enum status start(struct run *run, struct reason *reason)
{
    const struct drying_conditions *conditions = run->conditions;
    struct occupancy *occupancy = &run->occupancy;
    const int n = occupancy->network->n_throat;
    if (!conditions->start && conditions->start_saturation == 1) return STATUS_OK;
    double *invaded = NEW_ARRAY(double, n);
    const double *left = conditions->start ? conditions->start : invaded;
    enum status status = STATUS_OK;
    if (!conditions->start)
        status = invaded_saturations(occupancy, conditions->start_saturation,
                                     conditions->start_trapping, invaded, reason);
    const double *rings = run->conditions->rings ? conditions->start_rings : NULL;
    if (!status) start_from(occupancy, left, rings);
    for (int t = 0; !status && t < n; t++)
        if (occupancy->volume[t] > 0 && left[t] < 1)
            recorder_add_change(&run->recorder, t, left[t]);
    for (int i = 0; !status && rings && i < occupancy->network->n_node; i++)
        if (rings[i] < 1) recorder_add_change(&run->recorder, n + i, rings[i]);
    free(invaded);
    return status;
}

// Makes what the kind of liquid needs, for the occupancy of now. Parts that a kind of
// liquid does not need stay zero, and freeing them does nothing.
static void prepare(struct run *run)
{
    const struct network *network = run->occupancy.network;
    const bool is_viscous = run->conditions->liquid == LIQUID_VISCOUS;
    const bool has_kelvin = run->conditions->kelvin;
    if (is_viscous)
        run->flow = liquid_flow_init(
            &run->occupancy, run->scale.length, run->conditions->flow_step,
            menisci_init(network, run->conditions, &run->scale));
    if (has_kelvin) run->kelvin = kelvin_menisci_init(&run->occupancy, run->conditions);
    if (is_viscous && has_kelvin)
        run->coupling = kelvin_viscous_init(&run->kelvin, &run->flow);
    if (is_viscous && run->conditions->flow_step > 0)
        run->events = viscous_events_create(&run->occupancy, &run->flow);
    if (is_viscous || has_kelvin)
        run->losses = losses_init(network->n_throat);
    else
        run->times = emptying_times_init(&run->occupancy,
                                         run->conditions->liquid == LIQUID_IMMOBILE);
    if (run->conditions->rings == RINGS_FILMS)
        run->recorder.history->films = film_history_create();
    const int n = n_place_of(&run->occupancy);
    run->step_saturation = network_saturation(run);
    run->ended = NEW_ARRAY(int, n);
    run->is_ended = NEW_ARRAY(bool, n);
    run->saturation = NEW_ARRAY(double, n);
    for (int place = network->n_throat; place < n; place++)
        run->saturation[place] = 1;
    for (int t = 0; t < network->n_throat; t++)
        run->saturation[t] = occupancy_saturation(&run->occupancy, t);
}

// The order of entry under gravity, for clusters_init. The caller frees it.
static double *find_entry_priority(const struct network *network,
                                   const struct drying_conditions *conditions,
                                   const struct drying_scale *scale)
{
    struct menisci menisci = menisci_init(network, conditions, scale);
    double *entry_priority = NEW_ARRAY(double, network->n_throat);
    menisci_entry_priority(&menisci, entry_priority);
    menisci_free(&menisci);
    return entry_priority;
}

// In immobile liquid each throat is a body by itself, so gas in a node does not part
// clusters.
static enum status make_occupancy(const struct network *network, struct run *run,
                                  struct reason *reason)
{
    const struct drying_conditions *conditions = run->conditions;
    struct boundary_layer layer;
    enum status status = boundary_layers_init(
        network, conditions->open_walls, run->scale.length, run->scale.boundary_layer,
        &(struct boundary_form){conditions->feet, conditions->layers,
                                conditions->lumped},
        &layer, reason);
    if (status) {
        boundary_layer_free(&layer);
        return status;
    }
    if (conditions->rings)
        status = ring_stores_init(network, conditions, run->scale.length, &run->rings,
                                  reason);
    if (status) return status;
    if (conditions->rings == RINGS_FILMS)
        run->film_law = film_law_of(network, conditions, &run->scale);
    double *entry_priority = conditions->gravity != 0
                                 ? find_entry_priority(network, conditions, &run->scale)
                                 : NULL; // by radius
    const struct occupancy_form form = {
        .length = run->scale.length,
        .gas_parts = conditions->liquid != LIQUID_IMMOBILE,
        .entry_priority = entry_priority,
        .knudsen_radius = knudsen_radius(conditions),
        .vapour_tolerance = conditions->vapour_tolerance,
        .vapour_step = conditions->vapour_step,
        .rings = conditions->rings ? &run->rings : NULL,
        .films = conditions->rings == RINGS_JOINED,
        .film_law = run->film_law.conductance > 0 ? &run->film_law : NULL};
    status = occupancy_init(network, conditions->open_walls, &form, layer,
                            &run->occupancy, reason);
    free(entry_priority);
    return status;
}

// At the start, or from the checkpoint of another run. A restored run is prepared from
// a full network first, then all that was kept is read over it.
static enum status begin_run(struct run *run, const struct keeper *keeper,
                             struct reason *reason)
{
    if (keeper && keeper->begin) {
        prepare(run);
        return go_on_from(run, keeper->begin, reason);
    }
    enum status status = start(run, reason);
    if (status) return status;
    prepare(run);
    status = run->conditions->kelvin ? find_kelvin_losses(run, reason) : STATUS_OK;
    if (status) return status;
    if (!goes_on(run))
        return refuse(reason, STATUS_BAD_DATA,
                      "stop_saturation: must be below the saturation at the start, %g, "
                      "is %g",
                      network_saturation(run), run->conditions->stop_saturation);
    begin(run);
    if (run->conditions->kelvin) keep_pressures(run);
    return STATUS_OK;
}

static void free_run(struct run *run)
{
    liquid_flow_free(&run->flow);
    viscous_events_free(run->events);
    losses_free(&run->losses);
    kelvin_viscous_free(&run->coupling);
    kelvin_menisci_free(&run->kelvin);
    emptying_times_free(&run->times);
    free(run->ended);
    free(run->is_ended);
    free(run->saturation);
    occupancy_free(&run->occupancy);
    ring_stores_free(&run->rings);
}

// All checks before anything is made.
enum status dry_network(const struct network *network,
                        const struct drying_conditions *conditions,
                        const struct drying_progress *progress,
                        struct drying_history *history, struct reason *reason)
{
    *history = (struct drying_history){0};
    enum status status = check_conditions(conditions, reason);
    if (!status) status = check_gravity(network, conditions->gravity, reason);
    if (!status) status = check_throats(network, reason);
    if (!status) status = check_scale(conditions, network, reason);
    if (!status) status = check_kelvin(conditions, network, reason);
    if (!status) status = check_steps(conditions, network, reason);
    if (status) return status;

    struct run run = {.conditions = conditions,
                      .scale = drying_scale(network, conditions),
                      .recorder = recorder_init(history)};
    status = make_occupancy(network, &run, reason);
    const struct keeper *keeper = progress ? progress->keeper : NULL;
    if (!status) status = begin_run(&run, keeper, reason);
    if (!status) status = dry_all(&run, progress, reason);
    if (!status) summarise(&run, history);
    free_run(&run);
    return status;
}
