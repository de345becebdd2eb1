// SPDX-License-Identifier: GPL-3.0-or-later
// deform: the network of grains that have moved.
#include "artifacts/artifact.h"
#include "artifacts/write_network.h"
#include "basics/compensated.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "liquid.h"
#include "move.h"
#include "throats.h"

#include <stdlib.h>
#include <string.h>

enum on_change { CHANGE_REFUSED, CHANGE_KEPT };

struct deform_parameters {
    int clearance, on_change;
};

static const struct parameter table[] = {
    {"throat_radius", PARAMETER_CHOICE, "1", "\"segment\"", BOUND_NONE, 0, 0,
     "segment|line", "clearance that radii go with, as in tessellate",
     offsetof(struct deform_parameters, clearance)},
    {"on_change", PARAMETER_CHOICE, "1", "\"refuse\"", BOUND_NONE, 0, 0, "refuse|keep",
     "where moved grains have another diagram: nothing is written (exit status 1), or "
     "the network stays as it is connected",
     offsetof(struct deform_parameters, on_change)},
    {0}};

static const struct stage stage = {
    .name = "deform",
    .version = STAGE_VERSION,
    .summary = "deform -- the pore network of grains that have moved",
    .reads = "drying",
    .writes = "network",
    .most_inputs = 2,
    .parameters = table,
    .notes = "Inputs: a drying, whose liquid at its end goes along, or a network; and "
             "the response of the same grains, whose last snapshot says where they are "
             "now."};

// ---- input --------------------------------------------------------------------------

static struct artifact *open_network(const char *path)
{
    struct artifact *input = artifact_open(path, NULL);
    const char *schema = input->schema->name;
    if (strcmp(schema, "network") && strcmp(schema, "drying"))
        die(STATUS_BAD_DATA, "%s: must be a drying or a network, is a %s",
            input_name(path), schema);
    return input;
}

static void check_scene(const struct network *network, const char *path)
{
    if (network->packing.n_body)
        die(STATUS_BAD_DATA,
            "%s: /domain/bodies: only the walls of a box go with their grains",
            input_name(path));
    if (is_layer(network))
        die(STATUS_BAD_DATA,
            "%s: /faces/particles: the network of a layer of grains "
            "(tessellate.dimensions=2) cannot be moved",
            input_name(path));
}

// Where the grains were at the last snapshot of RESPONSE, in place of their places.
static void take_places(const struct artifact *response, struct packing *packing)
{
    struct packing began = artifact_get_packing(response);
    const int n = packing->n_particle;
    if (began.n_particle != n)
        die(STATUS_BAD_DATA, "%s: /particles: has %d grains, but the network %d",
            input_name(response->path), began.n_particle, n);
    int n_snapshot;
    struct vector *displacement =
        artifact_get(response, "/snapshots/displacement", &n_snapshot);
    if (!n_snapshot)
        die(STATUS_BAD_DATA, "%s: /snapshots/displacement: must have at least one row",
            input_name(response->path));
    const struct vector *last = displacement + (size_t)(n_snapshot - 1) * (size_t)n;
    for (int i = 0; i < n; i++)
        packing->position[i] = add(began.position[i], last[i]);
    free(displacement);
    packing_free(&began);
}

// ---- liquid -------------------------------------------------------------------------

// (n_throat) Of each throat at the end of a drying.
static double *last_saturations(const struct artifact *drying,
                                const struct network *network)
{
    int n_step;
    int64_t *offset = artifact_get(drying, "/changes/offset", &n_step);
    int32_t *throat = artifact_get(drying, "/changes/throat", NULL);
    double *changed = artifact_get(drying, "/changes/saturation", NULL);
    double *saturation = NEW_ARRAY(double, network->n_throat);
    for (int t = 0; t < network->n_throat; t++)
        saturation[t] = network->throat_kind[t] == THROAT_NETWORK;
    for (int64_t k = 0; k < offset[n_step - 1]; k++)
        if (network->throat_kind[throat[k]] == THROAT_NETWORK)
            saturation[throat[k]] = changed[k];
    free(offset);
    free(throat);
    free(changed);
    return saturation;
}

struct liquid {
    double *saturation;      // (n_throat); NULL: none is known
    double volume, expelled; // m3
};

static struct liquid move_liquid(const struct artifact *input,
                                 const struct network *before,
                                 const struct network *after)
{
    struct liquid liquid = {0};
    if (strcmp(input->schema->name, "drying")) return liquid;
    double *volume = NEW_ARRAY(double, before->n_throat);
    for (int t = 0; t < before->n_throat; t++)
        volume[t] = throat_volume(before, t);
    double *saturation = last_saturations(input, before);
    liquid.saturation = NEW_ARRAY(double, before->n_throat);
    liquid.expelled =
        settle_liquid(after,
                      &(struct held_liquid){
                          volume, saturation,
                          (unsigned)artifact_get_number(input, "/summary/open_walls")},
                      liquid.saturation);
    struct compensated sum = {0};
    for (int t = 0; t < before->n_throat; t++)
        compensated_add(&sum, liquid.saturation[t] * throat_volume(after, t));
    liquid.volume = compensated_value(sum);
    free(volume);
    free(saturation);
    return liquid;
}

// -------------------------------------------------------------------------------------

static void refuse_change(int changed, int n_node, const char *path)
{
    die(STATUS_NO,
        "%s: the grains have another diagram now, at %d of %d nodes: tessellate them "
        "anew, or on_change=keep",
        input_name(path), changed, n_node);
}

static void check_moved(const struct network *network, const char *path)
{
    static const double largest = 1e150; // as the schemas have it
    bool fits = true;
    for (int i = 0; i < network->n_node; i++)
        fits &= norm(network->node_position[i]) <= largest;
    for (int t = 0; t < network->n_throat; t++)
        fits &= network->throat_radius[t] <= largest &&
                network->throat_length[t] <= largest &&
                throat_volume(network, t) <= largest;
    if (!fits)
        die(STATUS_BAD_DATA,
            "%s: /snapshots/displacement: no numbers hold the network of these grains",
            input_name(path));
}

// Gives the number of nodes at which the diagram has changed.
static int move_network(const struct network *before,
                        const struct deform_parameters *parameters,
                        struct network *after, const char *path, const char *response)
{
    struct surroundings around = find_surroundings(before);
    struct reason reason;
    move_box(&before->packing, &after->packing);
    move_nodes(before, &around, after);
    const int changed = count_changed_nodes(before, &around, after);
    surroundings_free(&around);
    if (changed && parameters->on_change == CHANGE_REFUSED)
        refuse_change(changed, before->n_node, path);
    enum status status =
        move_throats(before, (enum clearance)parameters->clearance, after, &reason);
    if (!status) status = move_volumes(before, changed > 0, after, &reason);
    if (status) die(status, "%s: %s", input_name(path), reason.text);
    check_moved(after, response);
    return changed;
}

static void write_moved(const struct network *network, const struct liquid *liquid,
                        int changed, int closed, const struct invocation *invocation,
                        json_t *inputs)
{
    char model[700];
    snprintf(model, sizeof model,
             "nodes where the grains around them are now, walls with the grains beside "
             "them\n"
             "radii as the clearance to the grains beside the throats\n"
             "%s\n"
             "%d nodes at which the grains would have another diagram by now\n",
             liquid->saturation
                 ? "liquid kept: what volumes leave over fills the narrowest menisci, "
                   "what they are short of leaves the widest"
                 : "liquid: none known",
             changed);
    struct artifact *artifact = artifact_create("network", invocation->output);
    put_network_with_summary(artifact, network);
    artifact_put_number(artifact, "/summary/changed_nodes", changed);
    artifact_put_number(artifact, "/summary/closed_throats", closed);
    if (liquid->saturation) {
        artifact_put(artifact, "/throats/saturation", liquid->saturation,
                     network->n_throat);
        artifact_put_number(artifact, "/summary/liquid_volume", liquid->volume);
        artifact_put_number(artifact, "/summary/expelled_volume", liquid->expelled);
    }
    artifact_finish(artifact, invocation, inputs, model);
}

int main(int argc, char **argv)
{
    struct deform_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    if (invocation.n_input != 2)
        die(STATUS_USAGE, "two inputs: a drying or network, and a response");
    struct artifact *input = open_network(invocation.inputs[0]);
    struct artifact *response = artifact_open(invocation.inputs[1], "response");
    struct network before = artifact_get_periodic_network(input);
    struct network after = artifact_get_periodic_network(input);
    check_scene(&before, input->path);
    take_places(response, &after.packing);

    const int changed =
        move_network(&before, &parameters, &after, input->path, response->path);
    struct liquid liquid = move_liquid(input, &before, &after);
    json_t *inputs = one_input(input);
    json_array_append_new(inputs, input_digest(response));
    write_moved(&after, &liquid, changed, count_closed_throats(&before, &after),
                &invocation, inputs);

    free(liquid.saturation);
    network_free(&before);
    network_free(&after);
    artifact_close(response);
    artifact_close(input);
    invocation_free(&invocation);
    return STATUS_OK;
}
