// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay.h"

#include "basics/memory.h"
#include "equilibrium.h"
#include "reaction.h"
#include "resume.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct run {
    const struct packing *packing;
    const struct load *load;
    const struct replay_settings *settings;
    struct response *response;
    const struct keeper *keeper;
    struct dem *dem; // of the two engines the one asked for
    struct equilibrium *equilibrium;
    struct vector *force; // (n_particle) of this step
    struct net_load taken_off;
    int n_before;        // bonds that an earlier replay has broken
    int restless_before; // loads of an earlier replay that did not come to rest
    int snaps_before;    // of an earlier replay
    struct replay_place place;
    struct kept_state kept; // of equilibria, the last
};

static enum status begin_equilibrium(struct run *run, struct reason *reason)
{
    const struct replay_settings *settings = run->settings;
    const struct equilibrium_setup setup = {
        .packing = run->packing,
        .fixed = settings->held,
        .has_wall = settings->support == SUPPORT_WALL,
        .is_free = settings->support == SUPPORT_FREE,
        .material = settings->material,
        .bond = settings->bond,
        .unstressed = settings->unstressed,
        .relative_strength = settings->relative_strength,
        .tolerance = settings->equilibrium_tolerance,
        .most_iterations = settings->most_iterations,
        .rolling = settings->rolling,
        .large_displacements = settings->large_displacements,
        .increment = settings->increment};
    return equilibrium_new(&run->equilibrium, &setup, reason);
}

// NULL: all have the mean.
static double *strengths(const struct run *run, double mean)
{
    const double *relative = run->settings->relative_strength;
    if (!relative) return NULL;
    double *strength = NEW_ARRAY(double, run->packing->n_bond);
    for (int b = 0; b < run->packing->n_bond; b++)
        strength[b] = mean * relative[b];
    return strength;
}

static enum status begin_dem(struct run *run, struct reason *reason)
{
    const struct replay_settings *settings = run->settings;
    const struct packing *packing = run->packing;
    const struct dem_wall beneath = {.point = packing->lower, .normal = {0, 0, 1}};
    double *normal = strengths(run, settings->bond.normal_strength);
    double *shear = strengths(run, settings->bond.shear_strength);
    const struct dem_setup setup = {
        .packing = packing,
        .material = settings->material,
        .bond = settings->bond,
        .normal_strength = normal,
        .shear_strength = shear,
        .liquid = settings->liquid.volume > 0 ? &settings->liquid : NULL,
        .fixed = settings->held,
        .unstressed = settings->unstressed,
        .n_wall = settings->support == SUPPORT_WALL,
        .wall = &beneath,
        .time_step_safety = settings->time_step_safety,
        .force_time_step = settings->force_time_step,
        .threads = settings->threads};
    const enum status status = dem_create(&run->dem, &setup, reason);
    free(normal);
    free(shear);
    return status;
}

// At the end: one chosen by the engine may have become shorter.
static void note_time_step(const struct run *run)
{
    const double safety = run->settings->time_step_safety;
    const double limit = dem_time_step_limit(run->dem);
    run->response->time_step = dem_time_step(run->dem);
    // Where nothing can touch no step is too long: then what [K 4.47] says is written.
    run->response->time_step_limit =
        isinf(limit) ? run->response->time_step / (isnan(safety) ? 1 : safety) : limit;
}

static bool is_explicit(const struct run *run)
{
    return run->settings->engine == ENGINE_EXPLICIT;
}

static enum status begin(struct run *run, struct reason *reason)
{
    return is_explicit(run) ? begin_dem(run, reason) : begin_equilibrium(run, reason);
}

// Forces keep their directions when grains turn as one, and would turn them further:
// what is taken off follows the grains, often enough to bring all such motion to rest.
enum { TAKE_OFF_EVERY = 16 }; // cycles

static void take_off(struct run *run)
{
    struct vector *state[3];
    for (int k = 0; k < 3; k++)
        state[k] = NEW_ARRAY(struct vector, run->packing->n_particle);
    dem_displacements(run->dem, state[0]);
    dem_velocities(run->dem, state[1]);
    dem_spins(run->dem, state[2]);
    const struct moving_grains now = {state[0], state[1], state[2],
                                      run->settings->material.density,
                                      TAKE_OFF_EVERY * dem_time_step(run->dem)};
    run->taken_off = take_off_net_load(run->packing, NULL, &now, run->force);
    for (int k = 0; k < 3; k++)
        free(state[k]);
}

// Time steps before those that every step of the load has. Where an earlier replay went
// before, its last load is on already.
static int64_t ramp(const struct run *run)
{
    const bool is_first = run->place.step == 0 && !run->settings->begin;
    return is_first ? run->settings->ramp : 0;
}

static void grow(struct run *run)
{
    const int64_t next = dem_cycle(run->dem) - run->place.began + 1;
    for (int i = 0; next < ramp(run) && i < run->packing->n_particle; i++)
        run->force[i] = scale((double)next / (double)ramp(run), run->force[i]);
}

// The load of STEP, on the grains as they are.
static void apply_load(struct run *run, int step)
{
    const size_t n = (size_t)run->packing->n_particle;
    memcpy(run->force, run->load->force + (size_t)step * n, n * sizeof *run->force);
    if (!is_explicit(run)) return; // equilibria see to it
    grow(run);
    if (run->settings->support == SUPPORT_FREE) take_off(run);
    dem_set_force(run->dem, run->force);
}

// [K 4.20] has no denominator once no contact carries a force: then all that is applied
// is unbalanced.
static double unbalanced_ratio(const struct dem *dem)
{
    const double ratio = dem_unbalanced_ratio(dem);
    return isinf(ratio) ? 1 : ratio;
}

// Without a load nothing remains to measure what is left by: both terms of [K 4.20]
// decay.
static bool is_loaded(const struct run *run)
{
    for (int i = 0; i < run->packing->n_particle; i++)
        if (norm(run->force[i]) > 0) return true;
    return false;
}

// CYCLES more, cut where the state may be kept, and where the load follows the grains,
// which must not depend on it.
static enum status run_cycles(struct run *run, int64_t cycles, struct reason *reason)
{
    const bool is_free = run->settings->support == SUPPORT_FREE;
    const int64_t end = dem_cycle(run->dem) + cycles;
    const int64_t most =
        is_free ? TAKE_OFF_EVERY : cycles_between_questions(run->packing->n_particle);
    while (dem_cycle(run->dem) < end) {
        const int64_t now = dem_cycle(run->dem), left = end - now;
        const int64_t next = is_free ? most - (now - run->place.began) % most : most;
        const enum status status = dem_run(run->dem, left < next ? left : next, reason);
        if (status) return status;
        if (is_free) apply_load(run, run->place.step);
        if (is_due(run->keeper))
            keep_state(run->keeper, run->dem,
                       save_response(run->response, run->packing, run->load->n_time,
                                     run->place));
    }
    return STATUS_OK;
}

// Until a step is as settled as wanted, which is looked at every 16 cycles from where
// those of every step end.
static enum status run_on(struct run *run, struct reason *reason)
{
    enum { LOOK_EVERY = 16 };
    const struct replay_settings *settings = run->settings;
    if (isnan(settings->tolerance) || !is_loaded(run)) return STATUS_OK;
    const int64_t first = run->place.began + ramp(run) + settings->cycles;
    for (;;) {
        const int64_t done = dem_cycle(run->dem) - first;
        const int64_t left = settings->most_cycles - done;
        const int64_t to_look = LOOK_EVERY - done % LOOK_EVERY;
        const bool looks = to_look == LOOK_EVERY || left <= 0;
        if (looks && unbalanced_ratio(run->dem) < settings->tolerance) return STATUS_OK;
        if (left <= 0)
            return refuse(reason, STATUS_NOT_CONVERGED,
                          "unbalanced ratio %g is not below %g after %lld cycles",
                          dem_unbalanced_ratio(run->dem), settings->tolerance,
                          (long long)settings->most_cycles);
        const enum status status =
            run_cycles(run, left < to_look ? left : to_look, reason);
        if (status) return status;
    }
}

static int64_t cycles_done(const struct run *run)
{
    return is_explicit(run) ? dem_cycle(run->dem)
                            : equilibrium_iterations(run->equilibrium);
}

static enum status settle_dem(struct run *run, struct reason *reason)
{
    const int64_t full = run->place.began + ramp(run);
    enum status status = STATUS_OK;
    while (!status && dem_cycle(run->dem) < full) {
        apply_load(run, run->place.step);
        status = run_cycles(run, 1, reason);
    }
    const int64_t left = full + run->settings->cycles - dem_cycle(run->dem);
    if (!status) status = run_cycles(run, left, reason);
    return status ? status : run_on(run, reason);
}

static enum status settle_equilibrium(struct run *run, struct reason *reason)
{
    const enum status status = equilibrium_find(run->equilibrium, run->force, reason);
    if (run->settings->support == SUPPORT_FREE)
        run->taken_off = equilibrium_load(run->equilibrium, run->force);
    return status;
}

static struct net_load reaction(const struct run *run)
{
    const enum support support = run->settings->support;
    const uint8_t *held = run->settings->held;
    if (support == SUPPORT_FREE)
        return (struct net_load){scale(-1, run->taken_off.force),
                                 scale(-1, run->taken_off.moment)};
    return is_explicit(run)
               ? reaction_of_dem(run->packing, run->dem, held, support == SUPPORT_WALL)
               : reaction_of_equilibrium(run->packing, run->equilibrium, held,
                                         run->force);
}

static enum status settle(struct run *run, int step, struct reason *reason)
{
    const enum status status =
        is_explicit(run) ? settle_dem(run, reason) : settle_equilibrium(run, reason);
    run->response->cycles[step] = cycles_done(run) - run->place.began;
    run->response->unbalanced_ratio[step] =
        is_explicit(run) ? unbalanced_ratio(run->dem)
                         : equilibrium_unbalanced_ratio(run->equilibrium);
    run->response->reaction[step] = reaction(run);
    if (!status) return STATUS_OK;
    struct reason cause = *reason;
    return refuse(reason, status, "step %d of the load (saturation %.3f): %.400s", step,
                  run->load->saturation[step], cause.text);
}

static const struct dem_crack *engine_cracks(const struct run *run, int *count)
{
    return is_explicit(run) ? dem_cracks(run->dem, count)
                            : equilibrium_cracks(run->equilibrium, count);
}

static void note_cracks(struct run *run, int step)
{
    struct response *response = run->response;
    int count;
    const struct dem_crack *cracks = engine_cracks(run, &count);
    cracks += run->n_before;
    count -= run->n_before;
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

static void take_snapshot(struct run *run, int step)
{
    const struct packing *packing = run->packing;
    struct snapshot *snapshot = &run->response->snapshot[run->response->n_snapshot++];
    *snapshot = (struct snapshot){
        .step = step,
        .time = run->load->time[step],
        .saturation = run->load->saturation[step],
        .displacement = NEW_ARRAY(struct vector, packing->n_particle),
        .force = duplicate(run->force, (size_t)packing->n_particle, sizeof *run->force),
        .intact = NEW_ARRAY(uint8_t, packing->n_bond)};
    if (is_explicit(run)) {
        dem_displacements(run->dem, snapshot->displacement);
        dem_bonds_intact(run->dem, snapshot->intact);
        snapshot->contact = dem_contacts(run->dem, &snapshot->n_contact);
        return;
    }
    equilibrium_displacements(run->equilibrium, snapshot->displacement);
    equilibrium_bonds_intact(run->equilibrium, snapshot->intact);
    snapshot->contact = equilibrium_contacts(run->equilibrium, &snapshot->n_contact);
}

static bool snapshot_due(const struct run *run, int step)
{
    const int next = run->response->n_snapshot;
    return next < run->settings->n_snapshot &&
           run->load->saturation[step] <= run->settings->snapshot[next];
}

// Where another replay is to go on, how grains lie is wanted too.
static void take_last_snapshot(struct run *run, int step)
{
    const struct response *response = run->response;
    const int last = response->n_snapshot - 1;
    if (!run->settings->keep_state || step < run->load->n_time - 1) return;
    if (last < 0 || response->snapshot[last].step < step) take_snapshot(run, step);
}

static enum status restore_engine(struct run *run, const struct array_list *engine,
                                  struct reason *reason)
{
    return is_explicit(run)
               ? dem_restore(run->dem, engine->array, engine->count, reason)
               : equilibrium_restore(run->equilibrium, engine, reason);
}

static enum status go_on(struct run *run, struct reason *reason)
{
    const struct kept_state *state = run->keeper->begin;
    const enum status status = restore_engine(run, &state->engine, reason);
    if (status) return status;
    struct engine_past past = {.cycle = cycles_done(run)};
    past.crack = engine_cracks(run, &past.n_crack) + run->n_before;
    past.n_crack -= run->n_before;
    return restore_response(run->response, run->packing, run->load,
                            run->settings->n_snapshot, &past, &state->stage,
                            &run->place, reason);
}

// The loads of an earlier replay once more: each takes its equilibrium from the last.
static enum status repeat_earlier(struct run *run, struct reason *reason)
{
    const size_t n = (size_t)run->packing->n_particle;
    int n_load;
    const struct vector *force =
        saved_loads(run->settings->begin, run->packing, &n_load, reason);
    if (!force) return STATUS_BAD_DATA;
    equilibrium_expect(run->equilibrium, n_load, force);
    for (int k = 0; k < n_load; k++) {
        memcpy(run->force, force + (size_t)k * n, n * sizeof *run->force);
        const enum status status = settle_equilibrium(run, reason);
        if (status) return status;
        if (!equilibrium_may_forget(run->equilibrium)) continue;
        equilibrium_forget(run->equilibrium); // as in one piece
        equilibrium_expect(run->equilibrium, n_load - 1 - k,
                           force + (size_t)(k + 1) * n);
    }
    equilibrium_cracks(run->equilibrium, &run->n_before);
    int grain;
    run->restless_before = equilibrium_restless(run->equilibrium, &grain);
    run->snaps_before = equilibrium_snaps(run->equilibrium, &grain);
    run->place.began = cycles_done(run);
    return STATUS_OK;
}

static enum status go_on_from_earlier(struct run *run, struct reason *reason)
{
    if (is_explicit(run) == saved_by_equilibria(run->settings->begin))
        return refuse(reason, STATUS_BAD_DATA,
                      "was kept by engine=%s, which alone can go on from it",
                      is_explicit(run) ? "quasi-static" : "explicit");
    if (!is_explicit(run)) return repeat_earlier(run, reason);
    const struct array_list *engine = run->settings->begin;
    const enum status status =
        dem_restore(run->dem, engine->array, engine->count, reason);
    if (status) return status;
    dem_cracks(run->dem, &run->n_before);
    run->place.began = dem_cycle(run->dem);
    return STATUS_OK;
}

static struct array_list save_engine(const struct run *run)
{
    if (!is_explicit(run))
        return save_loads(run->settings->begin, run->load, run->packing);
    struct array_list list;
    list.array = dem_save(run->dem, &list.count);
    return list;
}

static enum status do_step(struct run *run, struct reason *reason)
{
    const int step = run->place.step;
    apply_load(run, step);
    const enum status status = settle(run, step, reason);
    note_cracks(run, step);
    while (!status && snapshot_due(run, step))
        take_snapshot(run, step);
    if (!status) take_last_snapshot(run, step);
    run->place = (struct replay_place){step + 1, cycles_done(run)};
    return status;
}

static void expect_rest(struct run *run)
{
    const int step = run->place.step;
    equilibrium_expect(run->equilibrium, run->load->n_time - step,
                       run->load->force +
                           (size_t)step * (size_t)run->packing->n_particle);
}

// Equilibria are kept from where they forget, whether anyone asks or not, so that it
// makes no difference; what is given away is the last of these.
static void keep_equilibrium(struct run *run)
{
    if (run->place.step == run->load->n_time) return;
    if (equilibrium_may_forget(run->equilibrium)) {
        equilibrium_forget(run->equilibrium);
        expect_rest(run);
        if (!run->keeper || !run->keeper->due) return;
        free_kept_state(&run->kept);
        run->kept = (struct kept_state){
            equilibrium_save(run->equilibrium),
            save_response(run->response, run->packing, run->load->n_time, run->place)};
    }
    if (run->kept.engine.count > 0 && is_due(run->keeper))
        run->keeper->keep(run->keeper->context, &run->kept);
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
        .reaction = NEW_ARRAY(struct net_load, load->n_time),
        .snapshot = NEW_ARRAY(struct snapshot, settings->n_snapshot + 1)};
    struct run run = {.packing = packing,
                      .load = load,
                      .settings = settings,
                      .response = response,
                      .keeper = keeper,
                      .force = NEW_ARRAY(struct vector, packing->n_particle)};
    enum status status = begin(&run, reason);
    if (!status && settings->begin) status = go_on_from_earlier(&run, reason);
    if (!status && keeper && keeper->begin) status = go_on(&run, reason);
    if (run.equilibrium) expect_rest(&run);
    while (!status && run.place.step < load->n_time) {
        status = do_step(&run, reason);
        if (!status && run.equilibrium) keep_equilibrium(&run);
        if (progress && progress->report)
            progress->report(progress->context, (double)run.place.step / load->n_time);
    }
    if (run.equilibrium) {
        response->n_gone = equilibrium_gone(run.equilibrium, &response->first_gone);
        response->n_restless =
            equilibrium_restless(run.equilibrium, &response->restless) -
            run.restless_before;
        response->n_snap =
            equilibrium_snaps(run.equilibrium, &response->snapped) - run.snaps_before;
    }
    if (run.dem) note_time_step(&run);
    if (!status && settings->keep_state) response->engine = save_engine(&run);
    dem_free(run.dem);
    equilibrium_free(run.equilibrium);
    free_kept_state(&run.kept);
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
    }
    free(response->snapshot);
    free(response->crack);
    free(response->crack_step);
    free(response->unbalanced_ratio);
    free(response->cycles);
    free(response->cracks);
    free(response->reaction);
    dem_free_arrays(response->engine.array, response->engine.count);
    *response = (struct response){0};
}
