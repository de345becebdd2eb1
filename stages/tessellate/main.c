// SPDX-License-Identifier: GPL-3.0-or-later
// tessellate: the pore network between the grains.
#include "artifacts/artifact.h"
#include "artifacts/write_network.h"
#include "basics/status.h"
#include "diagram.h"
#include "network/void_volume.h"

#include <stdio.h>

enum diagram { DIAGRAM_POWER, DIAGRAM_VORONOI };
enum throat_volume { VOLUME_CYLINDER, VOLUME_VOID };

struct tessellate_parameters {
    int diagram, clearance, volume;
};

static const struct parameter table[] = {
    {"diagram", PARAMETER_CHOICE, "1", "\"power\"", BOUND_NONE, 0, 0, "power|voronoi",
     "power diagram (K's Dirichlet) or plain Voronoi; the same for grains of one size",
     offsetof(struct tessellate_parameters, diagram)},
    {"throat_radius", PARAMETER_CHOICE, "1", "\"segment\"", BOUND_NONE, 0, 0,
     "segment|line",
     "least clearance between throat and grains: over the throat itself, or over the "
     "infinite line through it [K 3.7]",
     offsetof(struct tessellate_parameters, clearance)},
    {"throat_volume", PARAMETER_CHOICE, "1", "\"cylinder\"", BOUND_NONE, 0, 0,
     "cylinder|void",
     "what a throat holds: the cylinder of its radius and length [K 3.3.4], or its "
     "share "
     "of the void between the grains (/throats/volume), the sum of which is exact",
     offsetof(struct tessellate_parameters, volume)},
    {0}};

static const struct stage stage = {
    .name = "tessellate",
    .version = STAGE_VERSION,
    .summary = "tessellate -- the pore network between the grains of a packing",
    .reads = "packing",
    .writes = "network",
    .most_inputs = 1,
    .parameters = table};

// In a Voronoi diagram larger grains stick out into the void of their neighbours'
// cells.
static enum status give_void_volumes(const struct tessellation *how,
                                     struct network *network, struct reason *reason)
{
    if (!how->power)
        return refuse(reason, STATUS_BAD_DATA,
                      "tessellate.throat_volume: void must go with diagram=power");
    return find_void_volumes(network, reason);
}

int main(int argc, char **argv)
{
    struct tessellate_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    struct artifact *input = artifact_open(invocation.inputs[0], "packing");
    struct packing packing = artifact_get_packing(input);

    struct network network;
    struct tessellation_report report;
    struct reason reason;
    const struct tessellation how = {.power = parameters.diagram == DIAGRAM_POWER,
                                     .clearance = (enum clearance)parameters.clearance};
    enum status status = tessellate(&packing, &how, &network, &report, &reason);
    if (!status && parameters.volume == VOLUME_VOID)
        status = give_void_volumes(&how, &network, &reason);
    if (status) die(status, "%s: %s", input_name(input->path), reason.text);

    char model[600];
    snprintf(model, sizeof model,
             "%s diagram, truncated to the box by reflecting grains in its walls\n"
             "throat radius: least clearance over the %s\n"
             "throat volume: %s\n"
             "%d throats without clearance, %d grains without a cell\n"
             "left out: periodic images, boundary layer\n",
             how.power ? "power" : "Voronoi",
             how.clearance == CLEARANCE_SEGMENT ? "throat" : "infinite line [K 3.7]",
             parameters.volume == VOLUME_VOID ? "its share of the void"
                                              : "the cylinder of its radius and length",
             report.n_closed, report.hidden);
    write_network(&network, &invocation, input, model);

    artifact_close(input);
    packing_free(&packing);
    network_free(&network);
    invocation_free(&invocation);
    return STATUS_OK;
}
