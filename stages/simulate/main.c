// SPDX-License-Identifier: GPL-3.0-or-later
// simulate: discrete elements for any scene of grains, walls, liquid bridges and bonds.
//
// In this order: the packing and, as a second input, forces on its grains; names become
// numbers (scene.h); grains that stand in walls are refused; the run (run.h); what the
// user should know; the artifact.
#include "artifacts/artifact.h"
#include "artifacts/checkpoint.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "control.h"
#include "foresee.h"
#include "parameters/estimate.h"
#include "run.h"
#include "unused.h"
#include "write_motion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct stage stage = {
    .name = "simulate",
    .version = STAGE_VERSION,
    .summary = "simulate -- discrete elements for any scene: grains, walls, liquid [G]",
    .reads = "packing",
    .writes = "motion",
    .most_inputs = 2,
    .parameters = simulate_table,
    .estimates = ESTIMATES_INPUT,
    .notes =
        "A second input is a forces artifact of the same grains (forces.row). With "
        "write=packing the output is a packing.",
    .checkpoints = true};

// Auxiliary grains have no material, and would take part as real ones.
static struct packing read_packing(const struct artifact *input)
{
    struct packing packing = artifact_get_solid_packing(input, "simulate");
    if (packing.n_particle == 0)
        die(STATUS_BAD_DATA, "%s: /particles: has no grains", input_name(input->path));
    return packing;
}

// Forces on the grains, N, by forces.row and forces.factor; NULL without a second
// input. Only the number of grains is compared: a forces artifact of a deformed packing
// has other positions, and is meant to be usable. FORCES.ROW below 0 counts from the
// end.
static struct vector *read_forces(const struct invocation *invocation,
                                  const struct simulate_parameters *parameters,
                                  const struct packing *packing, json_t *inputs)
{
    if (invocation->n_input < 2) return NULL;
    struct artifact *input = artifact_open(invocation->inputs[1], "forces");
    int n_time;
    struct vector *all = artifact_get(input, "/force", &n_time);
    const int64_t row =
        parameters->forces_row + (parameters->forces_row < 0 ? n_time : 0);
    if (row < 0 || row >= n_time)
        die(STATUS_BAD_DATA, "simulate.forces.row: there is no row %lld among %d",
            (long long)parameters->forces_row, n_time);
    struct packing theirs = artifact_get_packing(input);
    const size_t n = (size_t)packing->n_particle;
    if (theirs.n_particle != packing->n_particle)
        die(STATUS_BAD_DATA, "%s: /particles: has %d grains, but the packing has %d",
            input_name(input->path), theirs.n_particle, packing->n_particle);
    struct vector *force = NEW_ARRAY(struct vector, n);
    for (size_t i = 0; i < n; i++)
        force[i] = scale(parameters->forces_factor, all[(size_t)row * n + i]);
    json_array_append_new(inputs, input_digest(input));
    packing_free(&theirs);
    free(all);
    artifact_close(input);
    return force;
}

// In place: the setup of SCENE points into it. Dies on refusal. Velocities are copied
// into the scene.
static void read_scene(const struct simulate_parameters *parameters,
                       const struct packing *packing, const struct artifact *input,
                       struct scene *scene)
{
    struct vector *velocity = artifact_has_dataset(input, "/particles/velocity")
                                  ? artifact_get(input, "/particles/velocity", NULL)
                                  : NULL;
    for (int i = 0; velocity && i < packing->n_particle; i++)
        velocity[i] = subtract(velocity[i], strain_velocity(parameters, packing->lower,
                                                            packing->position[i]));
    struct reason reason;
    const enum status status =
        scene_init(parameters, packing, velocity, scene, &reason);
    if (status) die(status, "%s", reason.text);
    free(velocity);
}

// A servo whose force is further than this share from what it should be was too slow,
// or nothing pushed back. A wall whose servo has a table of time is left out: what its
// force should be changes with time. The load of the grains on a wall is against its
// normal, hence the sign.
static void warn_of_servos(const struct scene *scene, const struct outcome *outcome)
{
    static const double near = 0.05;
    const struct dem *dem = outcome->dem;
    for (int w = 0; w < scene->setup.n_wall; w++) {
        const struct dem_wall *wall = &scene->wall[w];
        const struct scene_wall *more = &scene->wall_more[w];
        const bool pressure = !isnan(more->servo_pressure);
        const double span = CONTROL_EVERY * dem_time_step(dem);
        const double factor = mean_factor(more->motion, dem_time(dem) - span, span);
        const double wanted =
            factor * (pressure ? more->servo_pressure * servo_area(scene, dem, w)
                               : wall->servo_force);
        if (!(wanted > 0)) continue;
        const struct dem_wall_state now = dem_wall_state(dem, w);
        const double has = 0 - dot(now.force, wall->normal) / norm(wall->normal);
        if (fabs(has - wanted) <= near * wanted) continue;
        report("walls.%s: ends with a force of %.4g N, its servo is to reach %.4g N: "
               "grains give way, or servo.largest_speed or the duration is too small",
               more->name, has, wanted);
    }
}

// Stages after this one refuse grains outside of the box.
static void warn_of_grains_outside(const struct scene *scene,
                                   const struct outcome *outcome)
{
    struct vector lower, upper;
    dem_box(outcome->dem, &lower, &upper);
    const struct packing *packing = scene->setup.packing;
    const int n = packing->n_particle;
    struct vector *x = NEW_ARRAY(struct vector, n);
    dem_positions(outcome->dem, x);
    int outside = 0, first = -1;
    for (int i = 0; i < n; i++) {
        bool in = true;
        for (int axis = 0; axis < 3; axis++)
            in = in && (packing->periodic[axis] ||
                        (component(x[i], axis) >= component(lower, axis) &&
                         component(x[i], axis) <= component(upper, axis)));
        outside += !in;
        if (!in && first < 0) first = i;
    }
    free(x);
    if (outside > 0)
        report("%d of %d grains, grain %d the first, end outside of the packing's box: "
               "take it in by pack.method=import with pack.lower and pack.upper",
               outside, n, first);
}

// What the model has and what it leaves out, for the provenance of the artifact.
static void describe(const struct simulate_parameters *parameters,
                     const struct scene *scene, const char *model, char *text,
                     size_t size)
{
    static const char *const laws[] = {"Hertz-Mindlin contacts [K 4.23]",
                                       "linear contacts [K 4.22]",
                                       "linear contacts of one duration [G 2]"};
    char liquid[200] = "";
    if (scene->setup.liquid)
        snprintf(liquid, sizeof liquid,
                 "liquid bridges between grains that have touched, %s: surface tension "
                 "%.6g N/m, contact angle %.6g degrees\n",
                 model, scene->liquid.surface_tension, parameters->contact_angle);
    if (parameters->adhesion > 0)
        snprintf(liquid, sizeof liquid,
                 "adhesion of dry contacts (JKR): work of adhesion %.6g J/m2\n",
                 parameters->adhesion);
    const bool bonds = scene->setup.packing->n_bond > 0;
    bool rolling = false;
    for (int k = 0; k < scene->n_material; k++)
        rolling = rolling || scene->material[k].rolling_friction > 0;
    snprintf(text, size,
             "discrete elements: leapfrog, %s, Coulomb friction [K 4.25]\n"
             "%d materials, %d walls, %d groups of grains, %d of them driven\n"
             "%s%s%s"
             "left out: %s%s%sflow of air or liquid around the grains\n",
             laws[parameters->law], scene->n_material, scene->setup.n_wall,
             scene->n_group, scene->n_driven,
             !bonds                                  ? ""
             : parameters->bond_kind == BOND_CONTACT ? "contact bonds\n"
                                                     : "parallel bonds\n",
             liquid, rolling ? "elastic-plastic rolling resistance\n" : "",
             bonds ? "" : "bonds, ", rolling ? "" : "rolling resistance, ",
             scene->setup.liquid ? "" : "liquid bridges, ");
}

static void write(const struct simulate_parameters *parameters,
                  const struct scene *scene, const struct outcome *outcome,
                  const struct invocation *invocation, json_t *inputs)
{
    char model[1000];
    const json_t *bridges = json_object_get(invocation->parameters, "bridges");
    describe(parameters, scene, json_string_value(json_object_get(bridges, "model")),
             model, sizeof model);
    const bool all = parameters->write == WRITE_MOTION;
    struct artifact *artifact =
        artifact_create(all ? "motion" : "packing", invocation->output);
    if (all)
        put_motion(artifact, scene, outcome);
    else
        put_final_packing(artifact, parameters, scene, outcome);
    artifact_finish(artifact, invocation, json_incref(inputs), model);
}

// A state that does not fit is the checkpoint's fault, any other failure the input's.
static void run(const struct simulate_parameters *parameters, struct scene *scene,
                const struct vector *force, const struct invocation *invocation,
                const struct keeper *keeper, struct outcome *outcome)
{
    struct progress bar = progress_begin(invocation->progress, invocation->quiet);
    struct reason reason;
    const enum status status =
        run_scene(parameters, scene, force, invocation->threads, progress_update, &bar,
                  keeper, outcome, &reason);
    progress_end(&bar);
    const bool kept = status == STATUS_BAD_DATA && keeper->begin;
    if (status)
        die(status, "%s: %s",
            input_name(kept ? invocation->checkpoint : invocation->inputs[0]),
            reason.text);
}

static void simulate(const struct simulate_parameters *parameters, struct scene *scene,
                     const struct vector *force, struct invocation *invocation,
                     json_t *inputs)
{
    struct checkpoint checkpoint;
    checkpoint_begin(&checkpoint, invocation, inputs);
    struct outcome outcome;
    run(parameters, scene, force, invocation, &checkpoint.keeper, &outcome);
    if (!invocation->quiet) warn_of_servos(scene, &outcome);
    if (!invocation->quiet && parameters->write == WRITE_PACKING)
        warn_of_grains_outside(scene, &outcome);
    write(parameters, scene, &outcome, invocation, inputs);
    checkpoint_end(&checkpoint);
    outcome_free(&outcome);
}

static void estimate(const struct simulate_parameters *parameters, struct scene *scene)
{
    struct cost cost;
    struct reason reason;
    const enum status status = foresee_run(parameters, scene, &cost, &reason);
    if (status) die(status, "%s", reason.text);
    print_estimate(&cost,
                   &(struct body_size){.grains = scene->setup.packing->n_particle});
}

// Without bond.kind nothing after this sees the bonds of the packing. A user who goes
// on with the packing written may count on them, so this is said.
static void drop_bonds(const struct simulate_parameters *parameters,
                       const struct invocation *invocation, struct packing *packing)
{
    const bool tells = !invocation->quiet && !invocation->estimates;
    if (tells && parameters->write == WRITE_PACKING && packing->n_bond > 0)
        report("%s: none of its %d bonds are in the packing written (bond.kind=none); "
               "dem-replay.bond.by=touching bonds grains that touch then",
               input_name(invocation->inputs[0]), packing->n_bond);
    packing->n_bond = 0;
}

int main(int argc, char **argv)
{
    struct simulate_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    check_parameters(&parameters);
    check_unused(&parameters, invocation.parameters, invocation.n_input > 1);
    struct artifact *input = artifact_open(invocation.inputs[0], "packing");
    struct packing packing = read_packing(input);
    json_t *inputs = one_input(input);
    struct vector *force = read_forces(&invocation, &parameters, &packing, inputs);
    if (parameters.bond_kind == BOND_NONE)
        drop_bonds(&parameters, &invocation, &packing);
    struct scene scene;
    read_scene(&parameters, &packing, input, &scene);
    if (invocation.estimates)
        estimate(&parameters, &scene);
    else
        simulate(&parameters, &scene, force, &invocation, inputs);

    scene_free(&scene);
    free(force);
    json_decref(inputs);
    packing_free(&packing);
    artifact_close(input);
    named_rows_free(&parameters.materials);
    named_rows_free(&parameters.pairs);
    named_rows_free(&parameters.walls);
    named_rows_free(&parameters.groups);
    invocation_free(&invocation);
    return STATUS_OK;
}
