// SPDX-License-Identifier: GPL-3.0-or-later
// dry: which throat empties when.
//
// In this order: read the network; complete the conditions, whose defaults depend on
// it; draw radii if asked; take out throats imposed empty, without clearance, or shut
// in by these, which the drying counts as empty from the start; read the saturations to
// start from; find the checkpoint to go on from; dry (drying.h); write.
#include "artifacts/artifact.h"
#include "artifacts/body_size.h"
#include "artifacts/checkpoint.h"
#include "artifacts/liquid.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "conditions.h"
#include "dry/gas/mass_transfer.h"
#include "dry/run/drying.h"
#include "dry/run/initial_saturation.h"
#include "network/enclosed.h"
#include "parameters.h"
#include "parameters/estimate.h"
#include "write_drying.h"

#include <math.h>
#include <omp.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static const struct stage stage = {
    .name = "dry",
    .version = STAGE_VERSION,
    .summary = "dry -- dry a pore network throat by throat [K 3.4]",
    .reads = "network",
    .writes = "drying",
    .most_inputs = 1,
    .parameters = dry_table,
    .estimates = ESTIMATES_SIZES,
    .checkpoints = true};

// Saturation falls during the drying, so a rising list could not be met in its order.
static void check_snapshots(const struct dry_parameters *parameters)
{
    const struct number_list *snapshots = &parameters->snapshots;
    const double interval = parameters->snapshot_interval;
    if (interval > 0 && (snapshots->count > 0 || interval < 1e-4))
        die(STATUS_BAD_DATA,
            "dry.snapshot_interval: must be 0 or at least 1e-4, and 0 with a list of "
            "snapshots, got %g",
            interval);
    for (int k = 1; k < snapshots->count; k++)
        if (snapshots->value[k] >= snapshots->value[k - 1])
            die(STATUS_BAD_DATA,
                "dry.snapshots: must fall from one to the next, got %g after %g",
                snapshots->value[k], snapshots->value[k - 1]);
}

// A network, or a drying to begin within.
static struct artifact *open_input(const char *path)
{
    struct artifact *input = artifact_open(path, NULL);
    const char *schema = input->schema->name;
    if (strcmp(schema, "network") && strcmp(schema, "drying"))
        refuse_kind(path, "network", schema);
    return input;
}

// An artifact of a finished drying has none left.
static bool holds_liquid(const struct network *network, const double *saturation)
{
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK && saturation[t] > 0) return true;
    return false;
}

// Throat by throat, from a drying or a network that says how full they are; else NULL.
// The caller frees it. A drying has no saturations of its own at any moment but its
// changes: they are replayed down to SATURATION. *RINGS becomes what the rings hold
// then at each node, where it has any.
static double *read_start(const struct artifact *input, const struct network *network,
                          double saturation, double **rings)
{
    if (artifact_has_dataset(input, "/throats/saturation"))
        return artifact_get(input, "/throats/saturation", NULL);
    if (strcmp(input->schema->name, "drying")) return NULL;
    struct drying_record record = artifact_get_drying(input);
    const int n_step = record.n_step;
    if (n_step < 1 || !(saturation <= record.saturation[0]))
        die(STATUS_BAD_DATA,
            "dry.start_saturation: must be at most that at which %s begins, %g, is %g",
            input_name(input->path), n_step > 0 ? record.saturation[0] : 0, saturation);
    double *start = recorded_saturations(network, &record, saturation);
    if (!holds_liquid(network, start))
        die(STATUS_BAD_DATA,
            "%s: /changes/saturation: no throat holds liquid any more at "
            "dry.start_saturation %g",
            input_name(input->path), saturation);
    if (artifact_has_rings(input)) {
        struct ring_record held = artifact_get_rings(input);
        *rings = recorded_rings(network, &record, &held.changes, saturation);
        ring_record_free(&held);
    }
    drying_record_free(&record);
    return start;
}

static void dry(const struct network *network, const struct dry_parameters *parameters,
                const struct invocation *invocation, const char *path,
                const struct keeper *keeper, struct drying_history *history)
{
    struct progress bar = progress_begin(invocation->progress, invocation->quiet);
    struct reason reason;
    const enum status status = dry_network(
        network, &parameters->conditions,
        &(struct drying_progress){progress_update, &bar, keeper}, history, &reason);
    progress_end(&bar);
    // Only a state that was kept can be at fault for bad data after another run.
    if (status == STATUS_BAD_DATA && keeper->begin) path = invocation->checkpoint;
    if (status) die(status, "%s: %s", input_name(path), reason.text);
}

// The two axes along WALL: those other than wall / 2.
static double longer_open_edge(const struct packing *packing, int wall)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    return fmax(component(edge, (wall + 2) / 2 % 3),
                component(edge, (wall + 4) / 2 % 3));
}

// Says that a given thickness of the boundary layer is not used. A user who gives it
// and reads another number in the results would not know why.
static void note_unused_thickness(const struct dry_parameters *parameters,
                                  double thickness)
{
    static const double fallback = 5e-6; // of the parameter table
    const double given = parameters->air.thickness;
    if (parameters->transfer_law == TRANSFER_THICKNESS || given == fallback) return;
    report("boundary_layer.thickness = %g m does not count without "
           "boundary_layer.from=thickness: the layer is %.3g m thick",
           given, thickness);
}

// The length of the body along the flow, unless given, is the longer edge of the first
// open wall. Re and Sc need the diffusivity, hence after complete_conditions.
static struct mass_transfer give_mass_transfer(const struct network *network,
                                               struct dry_parameters *parameters,
                                               bool quiet)
{
    struct drying_conditions *conditions = &parameters->conditions;
    struct air_flow *air = &parameters->air;
    struct mass_transfer transfer;
    struct reason reason;
    if (!(air->length > 0) && conditions->open_walls)
        air->length =
            longer_open_edge(&network->packing, __builtin_ctz(conditions->open_walls));
    const enum status status =
        find_mass_transfer((enum transfer_law)parameters->transfer_law, air,
                           conditions->diffusivity, &transfer, &reason);
    if (status) die(status, "dry.%s", reason.text);
    conditions->mass_transfer = transfer.coefficient;
    if (!quiet) note_unused_thickness(parameters, transfer.thickness);
    if (parameters->transfer_law == TRANSFER_PLATE && transfer.sherwood < 1 && !quiet)
        report("boundary_layer: Sh = %.3g: thicker than the plate is long, where "
               "[K 3.6] does not hold (from=sphere does)",
               transfer.sherwood);
    return transfer;
}

// Empties the throats from which no path through liquid leads to a column of the
// boundary layer; returns their number. Their liquid could never dry, so the run would
// not end.
static int empty_enclosed(struct network *network, unsigned open_walls,
                          enum boundary_feet feet)
{
    bool *foot = NEW_ARRAY(bool, network->n_node);
    bool *open = NEW_ARRAY(bool, network->n_node);
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        if (!(open_walls >> wall & 1)) continue;
        boundary_feet_mark(network, wall, feet, foot);
        for (int i = 0; i < network->n_node; i++)
            open[i] = open[i] || foot[i];
    }
    const int enclosed = empty_enclosed_throats(network, open);
    free(foot);
    free(open);
    return enclosed;
}

// What was given for another liquid or temperature, as it seems, and what INPUT, which
// another drying has left, knows better. All properties, whether the run needs them or
// not, since all go into the artifact.
static void note_fluids(const struct dry_parameters *parameters,
                        const struct artifact *input)
{
    conditions_note(&parameters->given, ~0u);
    const struct liquid_properties told = liquid_of(&parameters->given);
    const struct liquid_properties left = artifact_get_liquid(input);
    char text[300];
    if (liquid_differs(&told, &left, input_name(input->path), text, sizeof text))
        report("%s", text);
}

// How many layers there will be: as given, or as the network of the input asks for; 1:
// not known, or lumped.
static double expected_layers(const struct invocation *invocation,
                              struct dry_parameters parameters)
{
    if (parameters.exchange == EXCHANGE_LUMPED) return 1;
    if (parameters.layers > 0 || !invocation->n_input)
        return fmax(1, (double)parameters.layers);
    struct artifact *input = open_input(invocation->inputs[0]);
    struct network network = artifact_get_periodic_network(input);
    struct reason reason;
    double layers = 1;
    if (!complete_conditions(&parameters, &network, &reason)) {
        give_mass_transfer(&network, &parameters, true);
        layers = drying_scale(&network, &parameters.conditions).boundary_layer;
    }
    free(parameters.even_snapshots);
    network_free(&network);
    artifact_close(input);
    return fmax(1, layers);
}

static int estimate(struct invocation *invocation,
                    const struct dry_parameters *parameters)
{
    const struct drying_conditions *conditions = &parameters->conditions;
    struct body_size body = input_size(invocation, parameters->open_walls);
    body.changes = recorded_changes(&body, conditions->step_interval);
    struct cost cost =
        cost_of_drying(&body, conditions->kelvin, !(conditions->vapour_tolerance > 0),
                       vapour_step(parameters, body.face, body.throats));
    if (parameters->liquid == LIQUID_VISCOUS)
        cost = with_viscous_flow(cost, &body, flow_step(parameters, body.throats) > 0);
    cost =
        with_boundary_layer(cost, body.face, expected_layers(invocation, *parameters));
    if (parameters->rings != RINGS_NONE)
        cost = with_rings(cost, &body, parameters->rings == RINGS_FILMS,
                          film_step(parameters, body.throats));
    return end_with_estimate(invocation, &cost, &body);
}

int main(int argc, char **argv)
{
    struct dry_parameters parameters = {.given = conditions_unset()};
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    omp_set_num_threads(invocation.threads);
    check_snapshots(&parameters);
    if (invocation.estimates) return estimate(&invocation, &parameters);
    struct artifact *input = open_input(invocation.inputs[0]);
    struct network network = artifact_get_periodic_network(input);

    struct reason reason;
    if (complete_conditions(&parameters, &network, &reason))
        die(STATUS_BAD_DATA, "dry.%s", reason.text);
    const struct mass_transfer transfer =
        give_mass_transfer(&network, &parameters, invocation.quiet);
    if (!invocation.quiet && !check_conditions(&parameters.conditions, &reason))
        note_fluids(&parameters, input);
    if (give_radii(&network, &parameters.radii, invocation.parameters, &reason))
        die(STATUS_BAD_DATA, "dry.%s", reason.text);
    if (!invocation.quiet) report_cut_radii(&parameters.radii);
    if (!invocation.quiet)
        report_repeated(input, &network, parameters.imposed_empty, "dry.imposed_empty");
    impose_empty_throats(&network, parameters.imposed_empty);
    parameters.shut = shut_closed_throats(&network);
    if (parameters.imposed_empty || parameters.shut)
        parameters.enclosed =
            empty_enclosed(&network, parameters.open_walls, parameters.conditions.feet);
    double *rings = NULL;
    double *start =
        read_start(input, &network, parameters.conditions.start_saturation, &rings);
    parameters.conditions.start = start;
    parameters.conditions.start_rings = rings;
    json_t *digest = one_input(input);
    struct checkpoint checkpoint;
    checkpoint_begin(&checkpoint, &invocation, digest);
    struct drying_history history;
    dry(&network, &parameters, &invocation, input->path, &checkpoint.keeper, &history);
    write_drying(&network, &history, &invocation, input, &parameters, &transfer);

    checkpoint_end(&checkpoint);
    json_decref(digest);
    drying_history_free(&history);
    free(start);
    free(rings);
    free(parameters.even_snapshots);
    network_free(&network);
    artifact_close(input);
    invocation_free(&invocation);
    return STATUS_OK;
}
