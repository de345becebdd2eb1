// SPDX-License-Identifier: GPL-3.0-or-later
// dem-replay: what the capillary forces do to the bonded grains.
//
// It reads the forces of a drying and, as a second input, the response of an earlier
// replay, whose packing then replaces that of the forces. Order matters: bonds first
// (choose_grains), because the choice of the engine and the strengths depend on them;
// the weight before the replay, because it is added to every row of the load, which is
// read as the replay comes to it. After the replay come warnings, then the artifact.
//
// In full: parameters; forces, or a packing that only shrinks; the liquid of bridges;
// the load; the earlier response; bonds, engine, strengths, held grains; the weight;
// the checkpoint; the replay (replay.h); the response (write_response.c).
//
// From forces it reads the packing, /time, /saturation and /force, the liquid, and
// /liquid_mass where grains shrink with it. From an earlier response it reads packing
// and /engine. It writes cracks, history, contacts and snapshots, with keep_state the
// engine's state for another replay.
//
// Exits 65 for inputs that do not fit each other or the parameters, 3 for a replay that
// was unstable or, if so wanted, did not come to rest. Bad data found in the replay are
// those of a state that was kept, so messages then name that file.
#include "artifacts/artifact.h"
#include "artifacts/body_size.h"
#include "artifacts/checkpoint.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "geometry/support.h"
#include "parameters.h"
#include "parameters/estimate.h"
#include "read_load.h"
#include "replay_engine.h"
#include "take_weight.h"
#include "warnings.h"
#include "write_response.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct stage stage = {
    .name = "dem-replay",
    .version = STAGE_VERSION,
    .summary = "dem-replay -- replay capillary forces on the bonded grains [K 4, 5.2]",
    .reads = "forces",
    .writes = "response",
    .most_inputs = 2,
    .parameters = replay_table,
    .estimates = ESTIMATES_SIZES,
    .notes =
        "A second input is the response of an earlier replay with keep_state, from "
        "which this one continues: with the positions of its grains and the bonds that "
        "have broken. Displacements count from the first positions of its grains.",
    .checkpoints = true};

// Without a bond nothing can break, whatever the forces. Bridges alone may be what is
// wanted, and so may contacts alone, but then the user says so.
static void check_bonds(const struct replay_parameters *parameters,
                        const struct packing *packing)
{
    static const char *const none[] = {
        [BONDS_BY_PACKING] = "the packing lists no bond between its",
        [BONDS_BY_TOUCHING] = "no two touch of",
        [BONDS_BY_DISTANCE] = "no two are within bond.gap of"};
    if (packing->n_bond || packing->n_particle < 2) return;
    if (parameters->bonds_by == BONDS_BY_NONE || parameters->settings.liquid.volume > 0)
        return;
    die(STATUS_BAD_DATA,
        "dem-replay.bond.by: %s %d grains, so that none can break: a wider "
        "pack.touching_gap, or bond.by=distance and bond.gap (`check` says how wide), "
        "or "
        "bond.by=none for contacts alone",
        none[parameters->bonds_by], packing->n_particle);
}

// Warns when bonds join fewer than half of the grains to fixed ones: the forces can
// carry the others away.
static void warn_if_unheld(const struct packing *packing, const uint8_t *held)
{
    const int n = packing->n_particle, supported = count_supported(packing, held);
    if (packing->n_bond && memchr(held, 1, (size_t)n) && supported < n / 2)
        report(
            "bonds join only %d of %d grains to those that are held: the others move "
            "as contacts let them (held, bond.by, pack.touching_gap)",
            supported, n);
}

// Bonds between a held grain and one that is not are FACTOR times as strong, on top of
// their scatter. Held grains must be known.
static void strengthen_substrate(double factor, const struct packing *packing,
                                 struct replay_settings *settings)
{
    if (factor == 1) return;
    double *strength = settings->relative_strength;
    if (!strength)
        strength = settings->relative_strength = equal_strengths(packing->n_bond);
    for (int b = 0; b < packing->n_bond; b++) {
        const int32_t *end = packing->bond[b];
        if (settings->held[end[0]] != settings->held[end[1]]) strength[b] *= factor;
    }
}

// Drawn, times those of the packing, times FACTOR at the substrate. The bonds of an
// EARLIER replay keep what they had in it.
static void choose_strengths(const struct replay_parameters *parameters,
                             const struct packing *packing, bool earlier,
                             struct replay_settings *settings)
{
    if (earlier && packing->bond_strength) {
        settings->relative_strength = copy_bond_strengths(packing);
        return;
    }
    struct strength_scatter scatter = parameters->scatter;
    scatter.law = (enum strength_law)parameters->strength_law;
    settings->relative_strength = bond_strengths(&scatter, packing);
    strengthen_substrate(parameters->substrate_strength, packing, settings);
}

// As held.walls refuses: through the seam the wall would push grains of both sides.
static void check_wall(const struct replay_settings *settings,
                       const struct packing *packing)
{
    if (settings->support == SUPPORT_WALL && packing->periodic[2])
        die(STATUS_BAD_DATA,
            "dem-replay.support: must not be wall in a box that is periodic along z, "
            "which has no wall there");
}

// The caller frees what it gives to SETTINGS. Grains are held by PARAMETERS only with
// support=fixed; otherwise the list is empty.
static void choose_grains(const struct replay_parameters *parameters,
                          struct packing *packing, bool earlier,
                          struct replay_settings *settings, bool quiet)
{
    bond_grains(packing, (enum bonds_by)parameters->bonds_by, parameters->bond_gap);
    choose_engine(parameters, packing, settings);
    check_bonds(parameters, packing);
    check_wall(settings, packing);
    struct fixed_grains held = parameters->held;
    if (settings->support != SUPPORT_FIXED)
        held =
            (struct fixed_grains){.lower = {NAN, NAN, NAN}, .upper = {NAN, NAN, NAN}};
    struct reason reason;
    const enum status status =
        find_fixed_grains(packing, &held, &settings->held, &reason);
    if (status) die(status, "dem-replay.%s", reason.text);
    choose_strengths(parameters, packing, earlier, settings);
    if (settings->support != SUPPORT_FIXED || packing->n_particle == 0) return;
    const bool one_moves = memchr(settings->held, 0, (size_t)packing->n_particle);
    if (!one_moves && !quiet) report("all grains are held, so that none moves");
    if (!quiet) warn_if_unheld(packing, settings->held);
    if (memchr(settings->held, 1, (size_t)packing->n_particle)) return;
    if (replay_engine(settings)->needs_support)
        die(STATUS_BAD_DATA,
            "dem-replay.held: none of the grains is held, without which "
            "there is no equilibrium (or support=free)");
    if (!quiet) report("support=fixed holds no grain: none touches held.walls");
}

// Masses are cubes of radii, moments of inertia fifth powers. m ~ R^3 and I ~ R^5:
// within these bounds both are numbers.
static void check_sizes(const struct packing *packing, const char *path)
{
    static const double smallest = 1e-60, largest = 1e60; // m
    for (int i = 0; i < packing->n_particle; i++) {
        const double radius = packing->radius[i];
        const struct vector at = packing->position[i];
        const double furthest = fmax(fmax(fabs(at.x), fabs(at.y)), fabs(at.z));
        if (radius < smallest || radius > largest || furthest > largest)
            die(STATUS_BAD_DATA,
                "%s: grain %d: radii must be from 1e-60 to 1e60 m, and places as near, "
                "for what grains weigh to be a number; got %g, %g m away",
                input_name(path), i, radius, furthest);
    }
}

// They have no bonds, but would touch, shrink and enclose pores as real ones. Forces
// have none.
static void check_auxiliary(const struct artifact *input, const struct packing *packing)
{
    for (int i = 0; is_packing(input) && i < packing->n_particle; i++)
        if (is_auxiliary(packing, i))
            die(STATUS_BAD_DATA,
                "%s: /particles/kind: grain %d is auxiliary: a packing that only "
                "shrinks or drains must have no extra layer (pack.extra_layer)",
                input_name(input->path), i);
}

// Menisci follow one packing from its beginning.
static void check_drains(const struct artifact *input,
                         const struct replay_parameters *parameters,
                         const struct invocation *invocation)
{
    if (!(parameters->settings.capillarity.suction > 0)) return;
    if (!is_packing(input))
        die(STATUS_BAD_DATA,
            "%s: holds forces: with capillary.suction dem-replay drains a packing "
            "itself, and takes that",
            input_name(input->path));
    if (invocation->n_input > 1 || parameters->settings.keep_state)
        die(STATUS_BAD_DATA, "dem-replay.capillary.suction: must be 0 with keep_state "
                             "or the response of "
                             "an earlier replay: what pores hold is not kept");
}

// Opens the forces, or a packing that is to shrink without any.
static struct artifact *open_input(const char *path)
{
    struct artifact *input = artifact_open(path, NULL);
    if (!is_packing(input) && strcmp(input->schema->name, "forces"))
        refuse_kind(path, "forces", input->schema->name);
    return input;
}

// What an earlier replay left, if one was named: the engine, and its PACKING. PACKING
// becomes that of the earlier response, whose grains have moved and whose bonds are
// numbered as it knew them.
static struct artifact *open_earlier(const struct invocation *invocation,
                                     struct packing *packing, struct array_list *engine)
{
    if (invocation->n_input < 2) return NULL;
    struct artifact *earlier = artifact_open(invocation->inputs[1], "response");
    *engine = artifact_get_arrays(earlier, "engine");
    if (!engine->count)
        die(STATUS_BAD_DATA, "%s: /engine: is not there: replay with keep_state=true",
            input_name(earlier->path));
    const int n = packing->n_particle;
    packing_free(packing);
    *packing = artifact_get_packing(earlier);
    if (packing->n_particle != n)
        die(STATUS_BAD_DATA, "%s: /particles: has %d grains, but %s has %d",
            input_name(earlier->path), packing->n_particle,
            input_name(invocation->inputs[0]), n);
    return earlier;
}

// In the order in which the inputs were named.
static json_t *digests(const struct artifact *input, const struct artifact *earlier)
{
    json_t *inputs = one_input(input);
    if (earlier) json_array_append_new(inputs, input_digest(earlier));
    return inputs;
}

static void run(const struct packing *packing, const struct load *load,
                const struct replay_settings *settings,
                const struct invocation *invocation, const char *path,
                const struct keeper *keeper, struct response *response)
{
    struct progress bar = progress_begin(invocation->progress, invocation->quiet);
    struct reason reason;
    const enum status status = replay(packing, load, settings,
                                      &(struct replay_progress){progress_update, &bar},
                                      keeper, response, &reason);
    progress_end(&bar);
    // Only a state that was kept can be at fault for bad data here.
    if (status == STATUS_BAD_DATA && keeper->begin) path = invocation->checkpoint;
    if (status == STATUS_BAD_DATA && settings->begin) path = invocation->inputs[1];
    if (status) die(status, "%s: %s", input_name(path), reason.text);
}

static const char *describe_loose(const struct replay_settings *settings)
{
    if (settings->engine != ENGINE_EXPLICIT) return "";
    return settings->loose == LOOSE_UNLOADED
               ? "loose grains: their net loads are taken off\n"
               : "loose grains: their loads go on\n";
}

static void describe_shrinkage(const struct shrinkage *how, char text[200])
{
    static const char *const by[] = {"as the saturation falls",
                                     "behind a front from the top",
                                     "as the liquid around each goes"};
    snprintf(text, 200,
             "grains and their bonds shrink by a strain of %.6g, %s; held ones do "
             "not\n",
             how->strain, by[how->law]);
}

static void describe_drainage(const struct capillarity *how, char text[300])
{
    static const char *const controls[] = {"rises to",
                                           "is what evaporation needs, at most"};
    static const char *const of[] = {"present", "first"};
    snprintf(
        text, 300,
        "liquid in the pores of the packing: one suction, which %s %.6g Pa; menisci "
        "pull on the %s facets, gas enters throats of the %s width\n",
        controls[how->control], how->suction, of[how->forces], of[how->throats]);
}

// The times of the first drying period go along, for crackstats.
static void write_response(const struct packing *packing, const struct load *load,
                           const struct replay_settings *settings,
                           const struct response *response,
                           const struct taken_weight *weight,
                           const struct invocation *invocation,
                           const struct artifact *input, json_t *inputs)
{
    static const char *const supports[] = {"free, net force and moment taken off",
                                           "%d grains held", "a rigid wall beneath"};
    char engine[200], support[60], weights[200], bridges[200] = "", model[2000];
    char shrinkage[200] = "", drainage[300] = "";
    replay_engine(settings)->describe(settings, engine, sizeof engine);
    int n_held = 0;
    for (int i = 0; i < packing->n_particle; i++)
        n_held += settings->held[i];
    snprintf(support, sizeof support, supports[settings->support], n_held);
    if (settings->liquid.volume > 0)
        snprintf(bridges, sizeof bridges,
                 "liquid bridges between grains that have touched [G 2], surface "
                 "tension %.6g N/m, contact angle %.6g degrees\n",
                 settings->liquid.surface_tension,
                 settings->liquid.contact_angle * (180 / M_PI));
    if (load->shrinks) describe_shrinkage(&settings->shrinkage, shrinkage);
    if (load->drains) describe_drainage(&settings->capillarity, drainage);
    snprintf(model, sizeof model,
             "%s\n"
             "engine: %s, %s\n"
             "%s"
             "support: %s\n"
             "overlaps of the packing %s\n"
             "%s%s%s%s%s"
             "left out: %s%smoments of capillary forces\n",
             engine, settings->engine == ENGINE_EXPLICIT ? "explicit" : "quasi-static",
             settings->engine_reason, describe_loose(settings), support,
             settings->unstressed ? "lie at rest" : "push from the start",
             settings->begin ? "goes on from where an earlier replay ended\n" : "",
             shrinkage, drainage, bridges, describe_weight(weight, weights),
             weight->gravity > 0 ? "" : "gravity, ",
             settings->liquid.volume > 0 ? "" : "liquid bridges at contacts, ");
    struct artifact *artifact = artifact_create("response", invocation->output);
    put_response(artifact, packing, load, settings, response);
    put_weight(artifact, weight, response);
    artifact_put_arrays(artifact, "engine", &response->engine);
    artifact_put_number(
        artifact, "/summary/first_period_end_time",
        is_packing(input)
            ? 0
            : artifact_get_number(input, "/summary/first_period_end_time"));
    artifact_finish(artifact, invocation, json_incref(inputs), model);
}

static void choose_bridges(struct replay_parameters *parameters,
                           const struct artifact *input, bool quiet)
{
    char difference[300];
    const struct artifact *forces = is_packing(input) ? NULL : input;
    if (*complete_bridges(parameters, forces, difference, sizeof difference) && !quiet)
        report("bridges: %s", difference);
}

// Only the number of grains and whether there are bonds decide on the engine; the input
// of a body that only shrinks or drains has no loads.
static int estimate(struct invocation *invocation, struct replay_parameters *parameters)
{
    struct replay_settings *settings = &parameters->settings;
    struct body_size body = input_size(invocation, 0);
    body.snapshots = settings->n_snapshot;
    const struct capillarity *drains = &settings->capillarity;
    if (drains->suction > 0)
        body.loads = (double)drains->steps;
    else if (!(body.loads > 0) && settings->shrinkage.strain > 0)
        body.loads = (double)parameters->shrinkage_steps;
    if (!(body.loads > 0))
        die(STATUS_USAGE, "--estimate: name forces as input, or a number of grains and "
                          "one of loads, as --estimate=1000,550");
    choose_engine(parameters,
                  &(struct packing){.n_particle = (int)body.grains, .n_bond = 1},
                  settings);
    const double ramp = (double)settings->ramp, cycles = (double)settings->cycles;
    const double most = (double)settings->most_cycles;
    const struct cost cost =
        settings->engine == ENGINE_QUASI_STATIC
            ? cost_of_equilibria(&body, settings->material.friction > 0)
        : drains->suction > 0
            ? cost_of_drainage(&body, ramp, cycles + least_cycles(drains), most)
            : cost_of_cycles(&body, ramp, cycles,
                             isnan(settings->tolerance) ? cycles : most);
    return end_with_estimate(invocation, &cost, &body);
}

int main(int argc, char **argv)
{
    struct replay_parameters parameters = {0};
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    struct replay_settings *settings = &parameters.settings;
    complete_settings(&parameters, invocation.threads);
    if (invocation.estimates) return estimate(&invocation, &parameters);
    struct artifact *input = open_input(invocation.inputs[0]);
    check_drains(input, &parameters, &invocation);
    choose_bridges(&parameters, input, invocation.quiet);
    struct packing packing = artifact_get_packing(input);
    check_sizes(&packing, input->path);
    check_auxiliary(input, &packing);
    struct load load = read_load(input, &parameters, packing.n_particle);
    struct array_list engine = {NULL, 0};
    struct artifact *earlier = open_earlier(&invocation, &packing, &engine);
    settings->begin = earlier ? &engine : NULL;
    choose_grains(&parameters, &packing, earlier, settings, invocation.quiet);
    settings->shrinkage.held = settings->held;
    struct taken_weight weight = take_weight(is_packing(input) ? NULL : input,
                                             &parameters, &packing, &load, settings);

    if (!invocation.quiet) warn_of_defaults(&parameters, &packing);
    json_t *digest = digests(input, earlier);
    struct checkpoint checkpoint;
    checkpoint_begin(&checkpoint, &invocation, digest);
    struct response response;
    run(&packing, &load, settings, &invocation, input->path, &checkpoint.keeper,
        &response);
    note_bond_numbers(&weight, largest_force(&load));
    if (!invocation.quiet) warn_of_replay(&packing, &load, settings, &response);
    if (!invocation.quiet) warn_of_weight(&weight, settings, &response, &packing);
    write_response(&packing, &load, settings, &response, &weight, &invocation, input,
                   digest);

    checkpoint_end(&checkpoint);
    json_decref(digest);
    free_arrays(engine.array, engine.count);
    if (earlier) artifact_close(earlier);
    response_free(&response);
    free(settings->relative_strength);
    free(settings->held);
    taken_weight_free(&weight);
    free_load(&load);
    packing_free(&packing);
    artifact_close(input);
    invocation_free(&invocation);
    return STATUS_OK;
}
