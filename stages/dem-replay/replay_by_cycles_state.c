// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a replay as cycles: made at the beginning, or restored from a checkpoint
// or from what an earlier replay has kept; and kept for a later one.
#include "replay_by_cycles.h"

#include "basics/memory.h"
#include "drainage_checkpoint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char due_name[] = "shrinkage_due", most_name[] = "most_liquid";

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

enum status create_dem(const struct run *run, struct dem **dem, struct reason *reason)
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
enum status restore_by_cycles(struct run *run, const struct kept_state *kept,
                              struct reason *reason)
{
    enum status status = restore_dem(run, &kept->engine, reason);
    if (!status)
        status = restore_load(&kept->stage, run->packing->n_particle, run->force,
                              &run->taken_off, reason);
    if (!status && run->load->drains)
        status = restore_drainage(&kept->stage, &state_of(run)->drainage,
                                  &run->response->drainage, run->load,
                                  run->packing->n_particle, reason);
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

enum status begin_by_cycles(struct run *run, struct reason *reason)
{
    struct by_cycles *state = run->state = NEW_ARRAY(struct by_cycles, 1);
    state->loose = loose_init(run->packing->n_particle);
    run->is_whole = run->settings->weight && !run->settings->begin;
    enum status status = create_dem(run, &state->dem, reason);
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

struct array_list save_by_cycles(const struct run *run)
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
