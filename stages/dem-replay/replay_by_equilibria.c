// SPDX-License-Identifier: GPL-3.0-or-later
// The replay as one equilibrium after another (quasi_static/quasi_static.h). The state
// of a replay is the sequence of its loads: a later one repeats them, each equilibrium
// starting from the last. Checkpoints are taken where the solver drops its caches, in
// runs with and without checkpoints alike, so that both make the same bytes. Cycles are
// iterations here. A load is settled if the number of loads that did not converge has
// not grown under it.
#include "replay_engine.h"

#include "basics/memory.h"
#include "detached.h"
#include "quasi_static/quasi_static.h"
#include "support_reaction.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct equilibria {
    struct quasi_static *last;
    int restless_before, snaps_before; // of an earlier replay
    bool is_settled;                   // under the load of this step
    struct kept_state kept;            // the last
};

static struct quasi_static *last(const struct run *run)
{
    return ((const struct equilibria *)run->state)->last;
}

static enum status check(const struct replay_settings *settings, struct reason *reason)
{
    if (settings->liquid.volume > 0)
        return refuse(reason, STATUS_BAD_DATA,
                      "dem-replay.bridges.volume: equilibria have no liquid bridges: "
                      "use engine=explicit");
    if (settings->shrinkage.strain > 0 && (settings->begin || settings->keep_state))
        return refuse(
            reason, STATUS_BAD_DATA,
            "dem-replay.shrinkage.strain: equilibria of grains that shrink do "
            "not go on from a response, and keep no state for later ones "
            "(dem-replay.keep_state): use engine=explicit");
    if (settings->capillarity.suction > 0)
        return refuse(reason, STATUS_BAD_DATA,
                      "dem-replay.capillary.suction: equilibria do not drain: use "
                      "engine=explicit");
    return STATUS_OK;
}

static void describe(const struct replay_settings *settings, char *text, size_t size)
{
    snprintf(text, size,
             "equilibria: linear contacts, slip, %s bonds that break one by one [K 4], "
             "%s displacements; what nothing holds leaves",
             settings->bond.kind == DEM_CONTACT_BOND ? "contact" : "parallel",
             settings->large_displacements ? "large" : "small");
}

// ---- begin --------------------------------------------------------------------------

// Reports progress within a step of the load.
static void tell(void *context, double balanced)
{
    const struct run *run = context;
    const struct replay_progress *progress = run->progress;
    if (progress && progress->report && run->place.step >= 0)
        progress->report(progress->context,
                         (run->place.step + balanced) / run->load->n_time);
}

static enum status create(struct run *run, struct reason *reason)
{
    const struct replay_settings *settings = run->settings;
    const struct quasi_static_setup setup = {
        .packing = run->packing,
        .fixed = settings->held,
        .has_wall = settings->support == SUPPORT_WALL,
        .is_free = settings->support == SUPPORT_FREE,
        .material = settings->material,
        .bond = settings->bond,
        .unstressed = settings->unstressed,
        .shrinks = settings->shrinkage.strain > 0,
        .relative_strength = settings->relative_strength,
        .tolerance = settings->equilibrium_tolerance,
        .most_iterations = settings->most_iterations,
        .rolling = settings->rolling,
        .large_displacements = settings->large_displacements,
        .increment = settings->increment,
        .report = tell,
        .context = run};
    struct equilibria *state = run->state = NEW_ARRAY(struct equilibria, 1);
    return quasi_static_create(&state->last, &setup, reason);
}

// Grains that have left have no load any more.
static enum status find(struct run *run, struct reason *reason)
{
    const enum status status = quasi_static_solve(last(run), run->force, reason);
    const bool *is_detached = quasi_static_is_detached(last(run));
    for (int i = 0; i < run->packing->n_particle; i++)
        if (is_detached[i]) run->force[i] = (struct vector){0, 0, 0};
    if (run->settings->support == SUPPORT_FREE)
        run->taken_off = quasi_static_load(last(run), run->force);
    return status;
}

// Repeats the loads of an earlier replay: each equilibrium starts from the last.
static enum status repeat(struct run *run, struct reason *reason)
{
    struct equilibria *state = run->state;
    const size_t n = (size_t)run->packing->n_particle;
    int n_load, grain;
    const struct vector *force =
        saved_loads(run->settings->begin, run->packing, &n_load, reason);
    if (!force) return STATUS_BAD_DATA;
    for (int k = 0; k < n_load; k++) {
        memcpy(run->force, force + (size_t)k * n, n * sizeof *run->force);
        const enum status status = find(run, reason);
        if (status) return status;
        if (quasi_static_cache_is_old(state->last))
            quasi_static_drop_cache(state->last); // as in one piece
    }
    state->restless_before = quasi_static_unconverged(state->last, &grain);
    state->snaps_before = quasi_static_instabilities(state->last, &grain);
    return STATUS_OK;
}

static enum status begin(struct run *run, struct reason *reason)
{
    const enum status status = create(run, reason);
    const struct array_list *earlier = run->settings->begin;
    if (status || !earlier) return status;
    if (!saved_by_equilibria(earlier)) return refuse_other_engine(reason, "explicit");
    return repeat(run, reason);
}

static enum status restore(struct run *run, const struct kept_state *kept,
                           struct reason *reason)
{
    return quasi_static_restore(last(run), &kept->engine, reason);
}

// ---- advance ------------------------------------------------------------------------

// Keeps a state whenever caches are dropped, and gives the last one away when a
// checkpoint is due.
static void keep(struct run *run)
{
    struct equilibria *state = run->state;
    if (quasi_static_cache_is_old(state->last)) {
        quasi_static_drop_cache(state->last);
        if (!run->keeper || !run->keeper->due) return;
        free_kept_state(&state->kept);
        state->kept = (struct kept_state){
            quasi_static_save(state->last),
            save_response(run->response, run->packing, run->load->n_time, run->place)};
    }
    if (state->kept.engine.count > 0 && is_due(run->keeper))
        run->keeper->keep(run->keeper->context, &state->kept);
}

// To what is due under the load of the step; none swells where liquid comes back.
static void shrink(struct run *run)
{
    const int n = run->packing->n_particle, row = run->place.step;
    if (!run->load->shrinks || row < 0) return;
    const double *before = quasi_static_shrinkage(last(run));
    double *strain = NEW_ARRAY(double, n);
    shrinkage_by_law(run, row, strain);
    for (int i = 0; i < n; i++)
        strain[i] = fmax(strain[i], before[i]);
    quasi_static_shrink(last(run), strain);
    free(strain);
}

static enum status advance(struct run *run, struct reason *reason)
{
    struct equilibria *state = run->state;
    int grain;
    const int before = quasi_static_unconverged(state->last, &grain);
    keep(run);
    take_forces(run);
    shrink(run);
    const enum status status = find(run, reason);
    state->is_settled = quasi_static_unconverged(state->last, &grain) == before;
    return status;
}

// ---- observations -------------------------------------------------------------------

static int64_t cycles(const struct run *run)
{
    return quasi_static_iterations(last(run));
}

static double unbalanced_ratio(const struct run *run)
{
    return quasi_static_unbalanced_ratio(last(run));
}

static bool is_settled(const struct run *run)
{
    return ((const struct equilibria *)run->state)->is_settled;
}

static struct net_load reaction(const struct run *run)
{
    return reaction_of_equilibrium(run->packing, last(run), run->settings->held,
                                   run->force);
}

// The solver's stress has compression above 0.
static double lateral_tension(const struct run *run)
{
    double stress[3][3];
    quasi_static_stress(last(run), stress);
    return -(stress[0][0] + stress[1][1]) / 2;
}

static const struct dem_crack *cracks(const struct run *run, int *count)
{
    return quasi_static_cracks(last(run), count);
}

static void observe(const struct run *run, struct snapshot *snapshot)
{
    quasi_static_displacements(last(run), snapshot->displacement);
    quasi_static_bonds_intact(last(run), snapshot->intact);
    snapshot->contact = quasi_static_contacts(last(run), &snapshot->n_contact);
    if (run->load->shrinks)
        snapshot->shrinkage =
            duplicate(quasi_static_shrinkage(last(run)),
                      (size_t)run->packing->n_particle, sizeof *snapshot->shrinkage);
}

static struct array_list save(const struct run *run)
{
    return save_loads(run->settings->begin, run->settings->weight, run->load,
                      run->packing);
}

static void end(struct run *run)
{
    struct equilibria *state = run->state;
    struct response *response = run->response;
    if (state->last) {
        int first;
        quasi_static_detached(state->last, &first);
        count_detached(run, quasi_static_is_detached(state->last), first);
        response->n_unconverged =
            quasi_static_unconverged(state->last, &response->unconverged_grain) -
            state->restless_before;
        response->n_instability =
            quasi_static_instabilities(state->last, &response->instability_grain) -
            state->snaps_before;
    }
    quasi_static_free(state->last);
    free_kept_state(&state->kept);
    free(state);
}

const struct replay_engine replay_by_equilibria = {
    .needs_support = true,
    .first_step = STEP_WEIGHT,
    .check = check,
    .describe = describe,
    .begin = begin,
    .restore = restore,
    .advance = advance,
    .cycles = cycles,
    .unbalanced_ratio = unbalanced_ratio,
    .is_settled = is_settled,
    .lateral_tension = lateral_tension,
    .reaction = reaction,
    .cracks = cracks,
    .observe = observe,
    .save = save,
    .end = end,
};
