// SPDX-License-Identifier: GPL-3.0-or-later
// The replay itself, the same for both engines: step after step of the load, the engine
// advances to rest or equilibrium (replay_engine.h), and what has happened is recorded:
// cracks with the step they broke in, the unbalanced ratio, the reaction of the
// supports, and snapshots at chosen saturations. Steps below 0 bring a body to rest
// under its weight before drying; bonds that break then count as broken before.
//
// For each step, in this order: the engine advances; cracks, cycles, ratio, settled and
// reaction are noted; snapshots that are due are taken; the place moves on. Cracks that
// an earlier replay or the weight has made are the first n_before of the engine's list
// and are skipped. The reaction of a free body is the load that was taken off, the
// other way.
#include "replay.h"

#include "basics/memory.h"
#include "replay_engine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct replay_engine *replay_engine(const struct replay_settings *settings)
{
    return settings->engine == ENGINE_EXPLICIT ? &replay_by_cycles
                                               : &replay_by_equilibria;
}

// ---- begin --------------------------------------------------------------------------

// The cracks of this replay: without those of an earlier one or of the weight.
static const struct dem_crack *own_cracks(const struct run *run, int *count)
{
    const struct dem_crack *cracks = run->engine->cracks(run, count);
    *count -= run->n_before;
    return cracks + run->n_before;
}

// The first step; after an earlier replay the body is at rest under its weight already.
static int first_step(const struct run *run)
{
    const struct replay_settings *settings = run->settings;
    return settings->weight && !settings->begin ? run->engine->first_step : 0;
}

static enum status continue_replay(struct run *run, struct reason *reason)
{
    const struct kept_state *state = run->keeper->begin;
    struct response *response = run->response;
    enum status status = run->engine->restore(run, state, reason);
    struct engine_past past = {0};
    if (!status) {
        own_cracks(run, &past.n_crack);
        status = restore_weight(response, past.n_crack, &state->stage, reason);
    }
    if (status) return status;
    run->n_before += response->n_weight_crack;
    past.first_step = first_step(run);
    past.cycle = run->engine->cycles(run);
    past.crack = own_cracks(run, &past.n_crack);
    status =
        restore_response(response, run->packing, run->load, run->settings->n_snapshot,
                         &past, &state->stage, &run->place, reason);
    for (int step = 0; step < run->place.step && !status; step++)
        response->loaded[step] = is_loaded(run->load, run->packing->n_particle, step);
    return status;
}

static enum status begin(struct run *run, struct reason *reason)
{
    const enum status status = run->engine->begin(run, reason);
    if (status) return status;
    run->engine->cracks(run, &run->n_before);
    run->response->n_earlier_crack = run->n_before;
    run->place = (struct replay_place){first_step(run), run->engine->cycles(run)};
    return run->keeper && run->keeper->begin ? continue_replay(run, reason) : STATUS_OK;
}

// ---- a step of the load -------------------------------------------------------------

static enum status advance(struct run *run, struct reason *reason)
{
    const int step = run->place.step;
    const enum status status = run->engine->advance(run, reason);
    if (!status) return STATUS_OK;
    struct reason cause = *reason;
    if (step < 0)
        return refuse(reason, status, "under the weight of the body alone: %.400s",
                      cause.text);
    return refuse(reason, status, "step %d of the load (saturation %.3f): %.400s", step,
                  run->load->saturation[step], cause.text);
}

static struct net_load reaction(const struct run *run)
{
    if (run->settings->support != SUPPORT_FREE) return run->engine->reaction(run);
    return (struct net_load){scale(-1, run->taken_off.force),
                             scale(-1, run->taken_off.moment)};
}

static void note_cracks(struct run *run)
{
    struct response *response = run->response;
    const int step = run->place.step;
    int count;
    const struct dem_crack *cracks = own_cracks(run, &count);
    response->crack =
        reallocate(response->crack, (size_t)count, sizeof *response->crack);
    response->crack_step =
        reallocate(response->crack_step, (size_t)count, sizeof *response->crack_step);
    for (int k = response->n_crack; k < count; k++) {
        response->crack[k] = cracks[k];
        response->crack_step[k] = step;
    }
    response->n_crack = response->cracks[step] = count;
}

// Bonds that break under the weight count as broken before drying.
static void note_weight(struct run *run)
{
    struct response *response = run->response;
    int count;
    own_cracks(run, &count);
    response->n_weight_crack += count;
    run->n_before += count;
    response->weight_unbalanced_ratio = run->engine->unbalanced_ratio(run);
}

// Cracks of earlier replays are the engine's first, or those under the weight: after an
// earlier replay the body stands already.
static void take_cracks_before(struct run *run)
{
    struct response *response = run->response;
    int count;
    const struct dem_crack *cracks = run->engine->cracks(run, &count);
    response->earlier_crack =
        duplicate(cracks, (size_t)response->n_earlier_crack, sizeof *cracks);
    response->weight_crack =
        duplicate(cracks, (size_t)response->n_weight_crack, sizeof *cracks);
}

static void note_step(struct run *run)
{
    struct response *response = run->response;
    const int step = run->place.step;
    response->cycles[step] = run->engine->cycles(run) - run->place.began;
    response->unbalanced_ratio[step] = run->engine->unbalanced_ratio(run);
    response->settled[step] = run->engine->is_settled(run);
    response->loaded[step] = is_loaded(run->load, run->packing->n_particle, step);
    response->reaction[step] = reaction(run);
    if (response->lateral_tension)
        response->lateral_tension[step] = run->engine->lateral_tension(run);
    note_cracks(run);
}

// ---- snapshots ----------------------------------------------------------------------

static void take_snapshot(struct run *run)
{
    const struct packing *packing = run->packing;
    const int step = run->place.step;
    struct snapshot *snapshot = &run->response->snapshot[run->response->n_snapshot++];
    *snapshot = (struct snapshot){
        .step = step,
        .time = run->load->time[step],
        .saturation = run->load->saturation[step],
        .displacement = NEW_ARRAY(struct vector, packing->n_particle),
        .force = duplicate(run->force, (size_t)packing->n_particle, sizeof *run->force),
        .intact = NEW_ARRAY(uint8_t, packing->n_bond)};
    run->engine->observe(run, snapshot);
}

// Several can be due at one load, if the saturation falls past more than one of them.
static bool is_snapshot_due(const struct run *run)
{
    const int next = run->response->n_snapshot;
    return next < run->settings->n_snapshot &&
           run->load->saturation[run->place.step] <= run->settings->snapshot[next];
}

// Takes the snapshots that are due; if the state is kept for a later replay, also one
// at the end.
static void take_snapshots(struct run *run)
{
    const struct response *response = run->response;
    const int step = run->place.step;
    while (is_snapshot_due(run))
        take_snapshot(run);
    if (!run->settings->keep_state || step < run->load->n_time - 1) return;
    const int last = response->n_snapshot - 1;
    if (last < 0 || response->snapshot[last].step < step) take_snapshot(run);
}

// ---- the whole ----------------------------------------------------------------------

static enum status do_step(struct run *run, struct reason *reason)
{
    const enum status status = advance(run, reason);
    if (status) return status;
    if (run->place.step < 0) {
        note_weight(run);
    } else {
        note_step(run);
        take_snapshots(run);
    }
    run->place = (struct replay_place){run->place.step + 1, run->engine->cycles(run)};
    return STATUS_OK;
}

enum status replay(const struct packing *packing, const struct load *load,
                   const struct replay_settings *settings,
                   const struct replay_progress *progress, const struct keeper *keeper,
                   struct response *response, struct reason *reason)
{
    *response = (struct response){
        .unbalanced_ratio = NEW_ARRAY(double, load->n_time),
        .cycles = NEW_ARRAY(int64_t, load->n_time),
        .cracks = NEW_ARRAY(int32_t, load->n_time),
        .settled = NEW_ARRAY(uint8_t, load->n_time),
        .loaded = NEW_ARRAY(uint8_t, load->n_time),
        .reaction = NEW_ARRAY(struct net_load, load->n_time),
        .weight_unbalanced_ratio = NAN,
        .snapshot = NEW_ARRAY(struct snapshot, settings->n_snapshot + 1)};
    if (load->drains) response->drainage = drainage_history_init(load->n_time);
    if (load->drains || load->shrinks)
        response->lateral_tension = NEW_ARRAY(double, load->n_time);
    struct run run = {.packing = packing,
                      .load = load,
                      .settings = settings,
                      .progress = progress,
                      .keeper = keeper,
                      .response = response,
                      .engine = replay_engine(settings),
                      .force = NEW_ARRAY(struct vector, packing->n_particle)};
    enum status status = begin(&run, reason);
    while (!status && run.place.step < load->n_time) {
        status = do_step(&run, reason);
        if (progress && progress->report && run.place.step >= 0)
            progress->report(progress->context, (double)run.place.step / load->n_time);
    }
    for (int k = 0; k < load->n_time; k++)
        response->n_unsettled += !response->settled[k];
    if (!status) take_cracks_before(&run);
    if (!status && settings->keep_state) response->engine = run.engine->save(&run);
    run.engine->end(&run);
    free(run.force);
    if (status) response_free(response);
    return status;
}

void response_free(struct response *response)
{
    for (int k = 0; k < response->n_snapshot; k++) {
        free(response->snapshot[k].displacement);
        free(response->snapshot[k].force);
        free(response->snapshot[k].intact);
        free(response->snapshot[k].contact);
        free(response->snapshot[k].dryness);
        free(response->snapshot[k].shrinkage);
    }
    free(response->snapshot);
    free(response->crack);
    free(response->crack_step);
    free(response->unbalanced_ratio);
    free(response->cycles);
    free(response->cracks);
    free(response->settled);
    free(response->loaded);
    free(response->reaction);
    free(response->lateral_tension);
    free(response->earlier_crack);
    free(response->weight_crack);
    drainage_history_free(&response->drainage);
    free_arrays(response->engine.array, response->engine.count);
    *response = (struct response){0};
}
