// SPDX-License-Identifier: GPL-3.0-or-later
// The replay as cycles of discrete elements [K 4, dem/dem.h]. At each step of the load
// the forces are applied and a fixed number of cycles runs; then, if asked for, more
// until the unbalanced ratio [K 4.20] is below the tolerance. Forces that nothing
// balances are removed at certain cycles only, counted from the beginning of the step:
// of a free body every TAKE_OFF_EVERY cycles, of loose fragments every STOP_EVERY, so
// that a run continued from a checkpoint makes the same bytes.
//
// A body with weight first comes to rest with unbreakable bonds and strong local
// damping (STEP_WHOLE), then with its true bonds (STEP_WEIGHT); drying begins from
// there.
#include "replay_by_cycles.h"

#include "basics/memory.h"
#include "dem/keep.h"
#include "detached.h"
#include "drainage_checkpoint.h"
#include "support_reaction.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void describe(const struct replay_settings *settings, char *text, size_t size)
{
    snprintf(text, size,
             "discrete elements: leapfrog, linear contacts, slip, dashpots, %s bonds "
             "[K 4]",
             settings->bond.kind == DEM_CONTACT_BOND ? "contact" : "parallel");
}

static enum status check(const struct replay_settings *settings, struct reason *reason)
{
    if (settings->shrinkage.strain > 0 && settings->liquid.volume > 0)
        return refuse(reason, STATUS_BAD_DATA,
                      "dem-replay.shrinkage.strain: must be 0 with liquid bridges "
                      "(bridges.volume), which do not follow grains that shrink");
    if (!(settings->capillarity.suction > 0)) return STATUS_OK;
    if (settings->liquid.volume > 0)
        return refuse(reason, STATUS_BAD_DATA,
                      "dem-replay.bridges.volume: must be 0 where capillary.suction "
                      "fills the pores with liquid");
    if (settings->shrinkage.strain > 0 && settings->shrinkage.law != SHRINKAGE_LIQUID)
        return refuse(reason, STATUS_BAD_DATA,
                      "dem-replay.shrinkage.law: must be liquid where "
                      "capillary.suction drains the pores");
    return STATUS_OK;
}

// ---- cycles -------------------------------------------------------------------------

// The ratio of [K 4.20] has no denominator if no contact carries a force: then the
// whole load is unbalanced.
static double unbalanced_ratio(const struct run *run)
{
    const double ratio = dem_unbalanced_ratio(dem_of(run));
    return isinf(ratio) ? 1 : ratio;
}

static void keep(const struct run *run)
{
    struct array_list list =
        save_response(run->response, run->packing, run->load->n_time, run->place);
    save_load(&list, run->force, run->packing->n_particle, run->taken_off);
    if (run->load->drains)
        save_drainage(&list, &state_of(run)->drainage, &run->response->drainage,
                      run->load, run->packing->n_particle);
    keep_state(run->keeper, dem_of(run), list);
}

static bool is_settled(const struct run *run)
{
    return unbalanced_ratio(run) < ratio_at_rest(run->settings) ||
           !is_loaded(run->load, run->packing->n_particle, run->place.step);
}

// Runs CYCLES, interrupted where the state may be kept, and where the load is adapted
// to the grains; the latter must not depend on the former.
static enum status run_cycles(struct run *run, int64_t cycles, struct reason *reason)
{
    const int64_t end = dem_cycle(dem_of(run)) + cycles, holds = load_holds(run);
    const int64_t most = cycles_between_questions(run->packing->n_particle);
    while (dem_cycle(dem_of(run)) < end) {
        const int64_t now = dem_cycle(dem_of(run)), left = end - now;
        const int64_t held = holds - (now - run->place.began) % holds;
        const int64_t next = held < most ? held : most;
        const enum status status =
            dem_run(dem_of(run), left < next ? left : next, reason);
        if (status) return status;
        if ((dem_cycle(dem_of(run)) - run->place.began) % holds == 0) apply_forces(run);
        if (is_due(run->keeper)) keep(run);
    }
    return STATUS_OK;
}

// Runs until the unbalanced ratio is below TOLERANCE, checked every 16 cycles from the
// FIRST on, but for at most MOST cycles.
static enum status settle(struct run *run, int64_t first, double tolerance,
                          int64_t most, struct reason *reason)
{
    enum { LOOK_EVERY = 16 };
    for (;;) {
        const int64_t done = dem_cycle(dem_of(run)) - first;
        const int64_t left = most - done;
        const int64_t to_look = LOOK_EVERY - done % LOOK_EVERY;
        const bool looks = to_look == LOOK_EVERY || left <= 0;
        if (looks && unbalanced_ratio(run) < tolerance) return STATUS_OK;
        if (left <= 0) return STATUS_OK;
        const enum status status =
            run_cycles(run, left < to_look ? left : to_look, reason);
        if (status) return status;
    }
}

// Where the user wants no step that has not come to rest.
static enum status refuse_unsettled(const struct run *run, struct reason *reason)
{
    const struct replay_settings *settings = run->settings;
    if (isnan(settings->tolerance) || settings->unsettled == UNSETTLED_GOES_ON)
        return STATUS_OK;
    if (unbalanced_ratio(run) < settings->tolerance) return STATUS_OK;
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "unbalanced ratio %g is not below %g after %lld cycles",
                  dem_unbalanced_ratio(dem_of(run)), settings->tolerance,
                  (long long)settings->most_cycles);
}

// After the fixed cycles of a step: more until the body is at rest, if a tolerance is
// given.
static enum status run_on(struct run *run, struct reason *reason)
{
    const struct replay_settings *settings = run->settings;
    if (isnan(settings->tolerance)) return STATUS_OK;
    if (!is_loaded(run->load, run->packing->n_particle, run->place.step))
        return STATUS_OK;
    const int64_t first = run->place.began + ramp(run) + settings->cycles;
    const enum status status =
        settle(run, first, settings->tolerance, settings->most_cycles, reason);
    return status ? status : refuse_unsettled(run, reason);
}

// ---- drainage -----------------------------------------------------------------------

// Rows of the load are known when they begin: grains shrink by the liquid left by then.
static void begin_drainage(struct run *run)
{
    const struct capillarity *how = &run->settings->capillarity;
    struct drainage *drainage = &state_of(run)->drainage;
    const int row = run->place.step;
    const size_t n = (size_t)run->packing->n_particle;
    const int64_t now = dem_cycle(dem_of(run));
    empty_distorted(drainage, dem_of(run));
    run->load->saturation[row] = row > 0 ? run->load->saturation[row - 1] : 1;
    if (run->load->drained)
        find_dryness(&drainage->liquid, run->load->drained + (size_t)row * n);
    aim_at_volume(drainage, row);
    if (how->control == CONTROL_SUCTION)
        aim_at_suction(drainage, how->suction * (row + 1) / (double)how->steps, now,
                       ramp(run) + run->settings->cycles);
    drainage->round_began = drainage->entered = now + ramp(run) + run->settings->cycles;
}

// A round; then gas enters what has opened; and so on until none does, and the body
// rests or has had the cycles for it. By evaporation until the step has lost its
// liquid. A round is never cut short: what a few pores change, the mean of [K 4.20]
// hides.
static enum status drain(struct run *run, struct reason *reason)
{
    const struct replay_settings *settings = run->settings;
    struct drainage *drainage = &state_of(run)->drainage;
    const bool dries = settings->capillarity.control == CONTROL_EVAPORATION;
    for (;;) {
        const int64_t done = dem_cycle(dem_of(run)) - drainage->round_began;
        const enum status status =
            run_cycles(run, settings->capillarity.round - done, reason);
        if (status) return status;
        const int64_t now = dem_cycle(dem_of(run));
        const bool rests = unbalanced_ratio(run) < ratio_at_rest(settings) ||
                           now - drainage->entered >= settings->most_cycles;
        const bool is_done = dries && has_evaporated(drainage);
        if (!(!is_done && enter_gas(drainage, dem_of(run)) > 0) && rests)
            return refuse_unsettled(run, reason);
        drainage->round_began = now;
        apply_forces(run);
    }
}

// The saturation never rises: what flows back as pores open is left out of it.
static void note_row(struct run *run)
{
    const int row = run->place.step;
    double *saturation = &run->load->saturation[row];
    *saturation = fmin(*saturation, note_drainage(&state_of(run)->drainage, dem_of(run),
                                                  row, &run->response->drainage));
}

// ---- weight -------------------------------------------------------------------------

// Local damping for coming to rest, as large as the time step, chosen for less, allows.
static double calming_share(const struct run *run)
{
    static const double share = 0.7;
    const double own = run->settings->material.local_damping;
    const double limit = dem_time_step_limit(dem_of(run)) * (1 + own);
    return fmax(own, fmin(share, limit / dem_time_step(dem_of(run)) - 1));
}

// Replaces unbreakable bonds by those of true strength, in the present state of the
// body.
static enum status give_strengths(struct run *run, struct reason *reason)
{
    struct by_cycles *state = run->state;
    struct dem *whole = state->dem;
    struct array_list list;
    list.array = dem_save(whole, &list.count);
    run->is_whole = false;
    enum status status = create_dem(run, &state->dem, reason);
    if (!status) status = dem_restore(state->dem, list.array, list.count, reason);
    free_arrays(list.array, list.count);
    dem_free(whole);
    return status;
}

// Brings the body to rest under its weight; limited, since loose grains may fall long.
static enum status stand(struct run *run, struct reason *reason)
{
    static const double settled = 1e-5; // a tenth of [K 5.2], as all goes on from here
    enum { MOST_STEPS = 100 };          // as long as so many of the load
    const struct replay_settings *settings = run->settings;
    const int64_t done = dem_cycle(dem_of(run)) - run->place.began;
    dem_set_local_damping(dem_of(run), calming_share(run));
    if (done == 0) apply_forces(run);
    const enum status status = done > 0 ? STATUS_OK : run_cycles(run, 1, reason);
    if (status) return status;
    return settle(run, run->place.began + 1,
                  isnan(settings->tolerance) ? settled : settings->tolerance,
                  MOST_STEPS * settings->cycles, reason);
}

// ---- advance ------------------------------------------------------------------------

static enum status advance(struct run *run, struct reason *reason)
{
    if (run->is_whole && run->place.step > STEP_WHOLE) {
        const enum status status = give_strengths(run, reason);
        if (status) return status;
    }
    if (run->place.step < 0) return stand(run, reason);
    if (run->settings->weight)
        dem_set_local_damping(dem_of(run), run->settings->material.local_damping);
    const int64_t full = run->place.began + ramp(run);
    enum status status = STATUS_OK;
    const bool begins = dem_cycle(dem_of(run)) == run->place.began;
    if (begins && run->load->drains) begin_drainage(run);
    if (begins) apply_forces(run);
    while (!status && dem_cycle(dem_of(run)) < full) {
        apply_forces(run);
        status = run_cycles(run, 1, reason);
    }
    const int64_t left = full + run->settings->cycles - dem_cycle(dem_of(run));
    // Without a ramp apply_forces has.
    if (!status && ramp(run) > 0 && left == run->settings->cycles) shrink(run);
    if (!status) status = run_cycles(run, left, reason);
    if (status || !run->load->drains) return status ? status : run_on(run, reason);
    status = drain(run, reason);
    if (!status) note_row(run);
    return status;
}

// ---- observations -------------------------------------------------------------------

static int64_t cycles(const struct run *run)
{
    return dem_cycle(dem_of(run));
}

static struct net_load reaction(const struct run *run)
{
    return reaction_of_dem(run->packing, dem_of(run), run->settings->held,
                           run->settings->support == SUPPORT_WALL);
}

// The engine's stress has compression above 0.
static double lateral_tension(const struct run *run)
{
    const struct dem_census census = dem_census(dem_of(run));
    const double grains = -(census.stress[0][0] + census.stress[1][1]) / 2;
    if (!run->load->drains) return grains;
    return grains + liquid_tension(&state_of(run)->drainage, dem_of(run));
}

static const struct dem_crack *cracks(const struct run *run, int *count)
{
    return dem_cracks(dem_of(run), count);
}

static void observe(const struct run *run, struct snapshot *snapshot)
{
    dem_displacements(dem_of(run), snapshot->displacement);
    dem_bonds_intact(dem_of(run), snapshot->intact);
    snapshot->contact = dem_contacts(dem_of(run), &snapshot->n_contact);
    if (run->load->shrinks) {
        snapshot->shrinkage = NEW_ARRAY(double, run->packing->n_particle);
        dem_shrinkage(dem_of(run), snapshot->shrinkage);
    }
    if (!run->load->drains) return;
    snapshot->dryness = NEW_ARRAY(double, run->packing->n_particle);
    find_dryness(&state_of(run)->drainage.liquid, snapshot->dryness);
}

// Notes the time step at the end: the engine may have shortened it.
static void note_time_step(const struct run *run)
{
    struct response *response = run->response;
    const double safety = run->settings->time_step_safety;
    const double limit = dem_time_step_limit(dem_of(run));
    response->time_step = dem_time_step(dem_of(run));
    // Where nothing can touch no step is too long: then what [K 4.47] says is written.
    response->time_step_limit =
        isinf(limit) ? response->time_step / (isnan(safety) ? 1 : safety) : limit;
}

static void end(struct run *run)
{
    struct by_cycles *state = run->state;
    if (state->dem) note_time_step(run);
    if (state->dem && unloads(run))
        find_loose(&state->loose, run->packing, run->settings->held, state->dem);
    count_detached(run, state->loose.is_loose, -1);
    loose_free(&state->loose);
    drainage_free(&state->drainage);
    dem_free(state->dem);
    free(state);
}

const struct replay_engine replay_by_cycles = {
    .first_step = STEP_WHOLE,
    .check = check,
    .describe = describe,
    .begin = begin_by_cycles,
    .restore = restore_by_cycles,
    .advance = advance,
    .cycles = cycles,
    .unbalanced_ratio = unbalanced_ratio,
    .is_settled = is_settled,
    .lateral_tension = lateral_tension,
    .reaction = reaction,
    .cracks = cracks,
    .observe = observe,
    .save = save_by_cycles,
    .end = end,
};
