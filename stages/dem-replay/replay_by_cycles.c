// SPDX-License-Identifier: GPL-3.0-or-later
// The replay as cycles of discrete elements [K 4, dem/dem.h]. At each step of the load
// the forces are applied and a fixed number of cycles runs; then, if asked for, more
// until the unbalanced ratio [K 4.20] is below the tolerance. Forces that nothing
// balances are removed at certain cycles only, counted from the beginning of the step:
// of a free body every TAKE_OFF_EVERY cycles, of loose fragments every STOP_EVERY, so
// that a run continued from a checkpoint makes the same bytes. At the first step the
// load grows linearly.
//
// A body with weight first comes to rest with unbreakable bonds and strong local
// damping (STEP_WHOLE), then with its true bonds (STEP_WEIGHT); drying begins from
// there. During the ramp of the first step, with share from 0 to 1,
//     force = weight + share (load - weight).
#include "replay_engine.h"

#include "basics/memory.h"
#include "dem/keep.h"
#include "drainage_checkpoint.h"
#include "loose.h"
#include "support_reaction.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct by_cycles {
    struct dem *dem;
    struct loose_grains loose; // none if they keep their loads
    bool has_looked;           // whether they have been found
    int n_crack;               // cracks at that time
    struct drainage drainage;  // where load->drains
    const double *due; // (n) shrinkage by the last row of the load of an earlier
                       // replay; NULL: there was none
};

static const char due_name[] = "shrinkage_due", most_name[] = "most_liquid";

static struct dem *dem_of(const struct run *run)
{
    return ((const struct by_cycles *)run->state)->dem;
}

static struct drainage *drainage_of(const struct run *run)
{
    return &((struct by_cycles *)run->state)->drainage;
}

static struct loose_grains *loose_of(const struct run *run)
{
    return &((struct by_cycles *)run->state)->loose;
}

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

// ---- begin --------------------------------------------------------------------------

// Strengths of the bonds; NULL: all have the mean.
static double *strengths(const struct run *run, double mean)
{
    const double *relative = run->settings->relative_strength;
    if (!relative && !run->is_whole) return NULL;
    double *strength = NEW_ARRAY(double, run->packing->n_bond);
    for (int b = 0; b < run->packing->n_bond; b++)
        strength[b] = run->is_whole ? INFINITY : mean * relative[b];
    return strength;
}

static enum status create(struct run *run, struct dem **dem, struct reason *reason)
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
        .shrinks = settings->shrinkage.strain > 0,
        .no_tensile_damping = !settings->tensile_damping,
        .n_wall = settings->support == SUPPORT_WALL,
        .wall = &beneath,
        .time_step_safety = settings->time_step_safety,
        .safety_key = "dem-replay.time_step_safety",
        .density_scaling = settings->density_scaling,
        .force_time_step = settings->force_time_step,
        .threads = settings->threads};
    const enum status status = dem_create(dem, &setup, reason);
    free(normal);
    free(shear);
    return status;
}

static enum status restore_dem(struct run *run, const struct array_list *list,
                               struct reason *reason)
{
    return dem_restore(dem_of(run), list->array, list->count, reason);
}

// Restores the load too: it is adapted to the grains at certain cycles only.
static enum status restore(struct run *run, const struct kept_state *kept,
                           struct reason *reason)
{
    enum status status = restore_dem(run, &kept->engine, reason);
    if (!status)
        status = restore_load(&kept->stage, run->packing->n_particle, run->force,
                              &run->taken_off, reason);
    if (!status && run->load->drains)
        status =
            restore_drainage(&kept->stage, drainage_of(run), &run->response->drainage,
                             run->load, run->packing->n_particle, reason);
    if (!status) dem_set_force(dem_of(run), run->force);
    return status;
}

// So that grains go on to shrink from where they were, and by the most liquid that they
// ever had, also in earlier replays.
static enum status take_shrinkage_on(struct run *run, const struct array_list *earlier,
                                     struct reason *reason)
{
    static const double largest = 1e150;
    struct by_cycles *state = run->state;
    const int n = run->packing->n_particle;
    double *most = run->load->most_liquid;
    const struct named_array *due =
        find_array(earlier->array, earlier->count, due_name);
    if (due && check_array(due, due_name, ARRAY_FLOAT64, n, 0, 1, reason))
        return STATUS_BAD_DATA;
    const struct named_array *had =
        find_array(earlier->array, earlier->count, most_name);
    if (had && check_array(had, most_name, ARRAY_FLOAT64, n, 0, largest, reason))
        return STATUS_BAD_DATA;
    if (due) state->due = due->data;
    for (int i = 0; most && had && i < n; i++)
        most[i] = fmax(most[i], ((const double *)had->data)[i]);
    return STATUS_OK;
}

// What the engine has kept: EARLIER without the arrays of the stage. Frees nothing.
static enum status restore_kept(struct run *run, const struct array_list *earlier,
                                struct reason *reason)
{
    struct array_list own = {NEW_ARRAY(struct named_array, earlier->count), 0};
    for (int k = 0; k < earlier->count; k++)
        if (strcmp(earlier->array[k].name, due_name) &&
            strcmp(earlier->array[k].name, most_name))
            own.array[own.count++] = earlier->array[k];
    const enum status status = restore_dem(run, &own, reason);
    free(own.array);
    return status;
}

static enum status begin(struct run *run, struct reason *reason)
{
    struct by_cycles *state = run->state = NEW_ARRAY(struct by_cycles, 1);
    state->loose = loose_init(run->packing->n_particle);
    run->is_whole = run->settings->weight && !run->settings->begin;
    enum status status = create(run, &state->dem, reason);
    if (!status && run->load->drains)
        status = drainage_begin(&state->drainage, &run->settings->capillarity,
                                run->packing, reason);
    const struct array_list *earlier = run->settings->begin;
    if (status || !earlier) return status;
    if (saved_by_equilibria(earlier))
        return refuse_other_engine(reason, "quasi-static");
    const bool shrank = find_array(earlier->array, earlier->count, "shrinkage");
    if (shrank != run->load->shrinks)
        return refuse(reason, STATUS_BAD_DATA,
                      "was kept by a replay %s shrinkage, and only one like it can go "
                      "on from there (dem-replay.shrinkage.strain)",
                      shrank ? "with" : "without");
    status = restore_kept(run, earlier, reason);
    return status ? status : take_shrinkage_on(run, earlier, reason);
}

// ---- loads --------------------------------------------------------------------------

// Forces keep their directions when a free body rotates, and would rotate it further:
// the load removed is adapted to the grains often enough to bring such motion to rest.
// Loose grains are stopped less often: the speed they gain meanwhile breaks nothing
// (their kinetic energy grows with the square of this number).
enum { TAKE_OFF_EVERY = 16, STOP_EVERY = 64 }; // cycles

// Menisci follow the grains as often: these move by a small part of a throat meanwhile.
enum { FOLLOW_EVERY = 16 };

// Whether loose grains are unloaded. Without bonds nothing can come loose, and liquid
// bridges hold loose grains.
static bool unloads(const struct run *run)
{
    return run->settings->loose == LOOSE_UNLOADED && run->packing->n_bond > 0 &&
           !(run->settings->liquid.volume > 0);
}

// Cycles after which the load is adapted to the grains again.
static int64_t load_holds(const struct run *run)
{
    if (run->load->drains) return FOLLOW_EVERY;
    if (run->load->shrinks && run->settings->support != SUPPORT_FREE) return STOP_EVERY;
    if (run->settings->support == SUPPORT_FREE) return TAKE_OFF_EVERY;
    return unloads(run) ? STOP_EVERY : INT64_MAX;
}

// Finds the loose grains again if bonds have broken, and stops them when it is time.
static void follow_loose(struct run *run)
{
    struct by_cycles *state = run->state;
    if (!unloads(run)) return;
    int n_crack;
    dem_cracks(state->dem, &n_crack);
    if (!state->has_looked || n_crack != state->n_crack)
        find_loose(&state->loose, run->packing, run->settings->held, state->dem);
    state->has_looked = true;
    state->n_crack = n_crack;
    const int64_t now = dem_cycle(state->dem) - run->place.began;
    if (state->loose.n_loose > 0 && now % STOP_EVERY == 0)
        dem_stop(state->dem, state->loose.is_loose);
}

// Removes the net loads of loose fragments. On a wall, the grains that are not loose
// take these over, so that the wall still carries the net load of all.
static void take_off_loose(struct run *run)
{
    const struct loose_grains *loose = loose_of(run);
    struct vector *displacement = NEW_ARRAY(struct vector, run->packing->n_particle);
    dem_displacements(dem_of(run), displacement);
    const struct net_load off =
        relieve_loose(loose, run->packing, displacement, run->force);
    if (run->settings->support == SUPPORT_WALL)
        put_on_net_load(run->packing, loose->is_loose, displacement, off, run->force);
    free(displacement);
}

// Removes the net load of a free body.
static void take_off(struct run *run)
{
    struct vector *state[3];
    for (int k = 0; k < 3; k++)
        state[k] = NEW_ARRAY(struct vector, run->packing->n_particle);
    dem_displacements(dem_of(run), state[0]);
    dem_velocities(dem_of(run), state[1]);
    dem_spins(dem_of(run), state[2]);
    const struct moving_grains now = {state[0], state[1], state[2],
                                      run->settings->material.density,
                                      TAKE_OFF_EVERY * dem_time_step(dem_of(run))};
    run->taken_off =
        take_off_net_load(run->packing, loose_of(run)->is_loose, &now, run->force);
    for (int k = 0; k < 3; k++)
        free(state[k]);
}

// Additional cycles of the first step, in which the load grows. After an earlier replay
// its last load is applied already.
static int64_t ramp(const struct run *run)
{
    const bool is_first = run->place.step == 0 && !run->settings->begin;
    return is_first ? run->settings->ramp : 0;
}

// Below the end of the ramp the load is a part of its row; without weight it grows from
// 0.
static void grow(struct run *run)
{
    const struct vector *weight = run->settings->weight; // is on already
    const int64_t next = dem_cycle(dem_of(run)) - run->place.began + 1;
    const double share = (double)next / (double)ramp(run);
    for (int i = 0; next < ramp(run) && i < run->packing->n_particle; i++)
        run->force[i] =
            weight ? add(weight[i], scale(share, subtract(run->force[i], weight[i])))
                   : scale(share, run->force[i]);
}

// The strain of each grain by the law, at ROW of the load or, -1, before it.
static void find_due(const struct run *run, int row, double *strain)
{
    const struct by_cycles *state = run->state;
    const int n = run->packing->n_particle;
    if (row < 0 && state->due)
        memcpy(strain, state->due, (size_t)n * sizeof *strain);
    else
        find_shrinkage(&run->settings->shrinkage, run->packing, row,
                       row < 0 ? 1 : run->load->saturation[row], dryness_at(run, row),
                       strain);
}

// Shrinks grains to SHARE of the way from the shrinkage of the row before to that of
// this one, but none swells: not where liquid comes back, nor after an earlier replay.
static void shrink_to(struct run *run, double share)
{
    const int n = run->packing->n_particle, row = run->place.step;
    if (!run->load->shrinks || row < 0) return;
    double *from = NEW_ARRAY(double, n), *to = NEW_ARRAY(double, n),
           *strain = NEW_ARRAY(double, n);
    find_due(run, row - 1, from);
    find_due(run, row, to);
    dem_shrinkage(dem_of(run), strain);
    for (int i = 0; i < n; i++)
        strain[i] = fmax(strain[i], from[i] + share * (to[i] - from[i]));
    dem_set_shrinkage(dem_of(run), strain);
    free(from);
    free(to);
    free(strain);
}

// Evenly over the cycles of the step, after the ramp: by now to what is due when the
// load is adapted next, so that the grains have felt all of it in the cycles of the
// step.
static void shrink(struct run *run)
{
    const int64_t since = dem_cycle(dem_of(run)) - run->place.began;
    const int64_t done = since - ramp(run), holds = load_holds(run);
    if (done < 0 || done >= run->settings->cycles) return;
    const int64_t next = done + holds - since % holds;
    shrink_to(run, fmin(1, (double)next / (double)run->settings->cycles));
}

// Applies the forces of the step to the grains where they are now.
static void apply_forces(struct run *run)
{
    shrink(run);
    take_forces(run);
    grow(run);
    if (run->load->drains && run->place.step >= 0)
        add_capillary_forces(drainage_of(run), dem_of(run), run->force);
    follow_loose(run);
    if (loose_of(run)->n_loose > 0) take_off_loose(run);
    if (run->settings->support == SUPPORT_FREE) take_off(run);
    dem_set_force(dem_of(run), run->force);
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
        save_drainage(&list, drainage_of(run), &run->response->drainage, run->load,
                      run->packing->n_particle);
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
    struct drainage *drainage = drainage_of(run);
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
    struct drainage *drainage = drainage_of(run);
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
    *saturation = fmin(*saturation, note_drainage(drainage_of(run), dem_of(run), row,
                                                  &run->response->drainage));
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
    enum status status = create(run, &state->dem, reason);
    if (!status) status = restore_dem(run, &list, reason);
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
    return grains + liquid_tension(drainage_of(run), dem_of(run));
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
    find_dryness(&drainage_of(run)->liquid, snapshot->dryness);
}

static struct array_list save(const struct run *run)
{
    struct array_list list;
    list.array = dem_save(dem_of(run), &list.count);
    const struct load *load = run->load;
    const int n = run->packing->n_particle;
    if (load->shrinks) {
        double *due = NEW_ARRAY(double, n);
        find_due(run, load->n_time - 1, due);
        add_array(&list, due_name, ARRAY_FLOAT64, n, due);
        free(due);
    }
    if (load->most_liquid)
        add_array(&list, most_name, ARRAY_FLOAT64, n, load->most_liquid);
    return list;
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
    run->response->n_detached = state->loose.n_loose;
    run->response->first_detached = state->loose.first_one;
    loose_free(&state->loose);
    drainage_free(&state->drainage);
    dem_free(state->dem);
    free(state);
}

const struct replay_engine replay_by_cycles = {
    .first_step = STEP_WHOLE,
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
