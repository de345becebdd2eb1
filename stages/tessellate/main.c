// SPDX-License-Identifier: GPL-3.0-or-later
// tessellate: the pore network between the grains. Reads a packing, writes a network.
//
// In this order: read grains, box and bodies; then all of diagram.h, that is diagram,
// nodes, throats with their clearances, faces, the cuts by bodies, what throats
// conduct, entry radii, boundary layer, cells left out, the plane of a layer; then the
// throats' shares of the void, if asked; write. Conductances and entry radii come
// before cells are left out, as they need every face around a throat. Shares of the
// void come last and need whole cells between flat walls: other networks are refused
// (give_void_volumes).
//
// The choices of throat_radius are enum clearance, and `entry` behind them, which is no
// clearance: those of `segment` are found first, and bound entry radii from below. A
// layer of grains (dimensions=2) gives a network in its plane, whose throats are
// cylinders of their clearance in any case: conductance is not looked at there, and
// entry acts as segment. contact_angle is in degrees here, in rad from here on.
//
// What refuses a packing (65) names the dataset and row. `model` in the provenance says
// which diagram, radii, volumes and conductances the network has.
#include "artifacts/artifact.h"
#include "artifacts/body_size.h"
#include "artifacts/write_network.h"
#include "basics/status.h"
#include "diagram.h"
#include "network/void_volume.h"
#include "parameters/estimate.h"

#include <omp.h>
#include <stdio.h>

enum diagram { DIAGRAM_POWER, DIAGRAM_VORONOI };
enum throat_volume { VOLUME_CYLINDER, VOLUME_VOID };
enum { RADIUS_ENTRY = CLEARANCE_BESIDE + 1 };
enum conductance { CONDUCTANCE_SECTION, CONDUCTANCE_CYLINDER };

struct tessellate_parameters {
    int diagram, clearance, volume, conductance, boundary;
    double contact_angle;
    int64_t dimensions;
};

static const struct parameter table[] = {
    {"diagram", PARAMETER_CHOICE, "1", "\"power\"",
     offsetof(struct tessellate_parameters, diagram), .choices = "power|voronoi",
     .text = "power diagram (K's Dirichlet) or plain Voronoi; the same for grains of "
             "one size"},
    {"throat_radius", PARAMETER_CHOICE, "1", "\"segment\"",
     offsetof(struct tessellate_parameters, clearance),
     .choices = "segment|line|beside|entry",
     .text =
         "least clearance between throat and grains: from the throat itself to any "
         "grain, from the infinite line through it to the grains beside it [K "
         "3.7], or from the throat to the grains beside it (for grains of one size "
         "these agree but line); entry: the radius whose capillary pressure is that "
         "at which gas enters between the grains, liquid staying in their gaps "
         "(Mayer, Stowe and Princen); of a layer as segment"},
    {"contact_angle", PARAMETER_NUMBER, "degree", "0",
     offsetof(struct tessellate_parameters, contact_angle), BETWEEN(0, 89.999),
     .text =
         "of the liquid on the grains, for throat_radius=entry: the one that dry or "
         "invade has"},
    {"throat_volume", PARAMETER_CHOICE, "1", "\"cylinder\"",
     offsetof(struct tessellate_parameters, volume), .choices = "cylinder|void",
     .text = "what a throat holds: the cylinder of its radius and length [K 3.3.4], or "
             "its share of the void between the grains (/throats/volume); these shares "
             "sum exactly to the void"},
    {"conductance", PARAMETER_CHOICE, "1", "\"section\"",
     offsetof(struct tessellate_parameters, conductance), .choices = "section|cylinder",
     .text = "what a throat conducts, to diffusion and to flow: as the open section "
             "between its grains, slice by slice along it (/throats/"
             "diffusive_conductance, ../hydraulic_conductance), or as the cylinder of "
             "its radius and length [K 3.9]; throats of a layer are always cylinders"},
    {"boundary", PARAMETER_CHOICE, "1", "\"truncate\"",
     offsetof(struct tessellate_parameters, boundary), .choices = "truncate|eliminate",
     .text = "cells that cross the walls of the box or of a cylinder, ring or sphere: "
             "truncate cuts them there; eliminate leaves them out, as K does with "
             "unbounded cells"},
    {"dimensions", PARAMETER_INTEGER, "1", "3",
     offsetof(struct tessellate_parameters, dimensions), BETWEEN(2, 3),
     .text = "2: the network of one layer of grains, in a plane between it and the "
             "next, which is as far away as the box is thick along y [K 3.3.6]"},
    {0}};

static const struct stage stage = {
    .name = "tessellate",
    .version = STAGE_VERSION,
    .summary = "tessellate -- the pore network between the grains of a packing",
    .reads = "packing",
    .writes = "network",
    .most_inputs = 1,
    .parameters = table,
    .estimates = ESTIMATES_SIZES};

// Gives volumes in m3 that sum to the void. In a Voronoi diagram larger grains stick
// out into the void of their neighbours' cells.
static enum status give_void_volumes(const struct tessellation *how,
                                     struct network *network, struct reason *reason)
{
    if (!how->power)
        return refuse(reason, STATUS_BAD_DATA,
                      "tessellate.throat_volume: void must go with diagram=power");
    if (how->layer || how->boundary == BOUNDARY_ELIMINATE || network->packing.n_body)
        return refuse(
            reason, STATUS_BAD_DATA,
            "tessellate.throat_volume: void must go with %s: leave it out, or say "
            "cylinder",
            how->layer || how->boundary == BOUNDARY_ELIMINATE
                ? "dimensions=3 and boundary=truncate, which leave cells whole"
                : "flat walls, not those of a cylinder, ring or sphere or of a part "
                  "cut out (pack.domain)");
    return find_void_volumes(network, reason);
}

// Says what becomes of the diagram at the sides of the box.
static const char *bounding(const struct packing *packing, enum boundary boundary,
                            char text[300])
{
    char along[4] = "";
    int count = 0;
    for (int axis = 0; axis < 3; axis++)
        if (packing->periodic[axis]) along[count++] = "xyz"[axis];
    const bool walls = count < 3;
    const char *bodies = packing->n_body
                             ? ", ended where throats meet the bodies of /domain/bodies"
                             : "";
    snprintf(text, 300, "%s%s%s%s%s",
             !walls ? ""
             : boundary == BOUNDARY_TRUNCATE
                 ? "truncated to the box by reflecting grains in its walls"
                 : "cells that the walls would cut left out",
             boundary == BOUNDARY_TRUNCATE ? bodies : "", walls && count ? ", " : "",
             count ? "repeated along " : "", along);
    return text;
}

// For `model`; by enum clearance.
static const char *const radius_rule[] = {
    [CLEARANCE_SEGMENT] = "the throat to any grain",
    [CLEARANCE_LINE] = "the infinite line through it to the grains beside it [K 3.7]",
    [CLEARANCE_BESIDE] = "the throat to the grains beside it"};

static int estimate(struct invocation *invocation)
{
    const struct body_size body = input_size(invocation, 0);
    const struct cost cost = cost_of_tessellation(body.grains);
    return end_with_estimate(invocation, &cost, &body);
}

int main(int argc, char **argv)
{
    struct tessellate_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    if (invocation.estimates) return estimate(&invocation);
    omp_set_num_threads(invocation.threads);
    struct artifact *input = artifact_open(invocation.inputs[0], "packing");
    struct packing packing = artifact_get_packing(input);

    struct network network;
    struct tessellation_report report;
    struct reason reason;
    const struct tessellation how = {
        .power = parameters.diagram == DIAGRAM_POWER,
        .clearance = parameters.clearance == RADIUS_ENTRY
                         ? CLEARANCE_SEGMENT
                         : (enum clearance)parameters.clearance,
        .entry = parameters.clearance == RADIUS_ENTRY && parameters.dimensions == 3,
        .contact_angle = parameters.contact_angle * (M_PI / 180),
        .boundary = (enum boundary)parameters.boundary,
        .shapes =
            parameters.conductance == CONDUCTANCE_SECTION && parameters.dimensions == 3,
        .layer = parameters.dimensions == 2};
    enum status status = tessellate(&packing, &how, &network, &report, &reason);
    if (!status && parameters.volume == VOLUME_VOID)
        status = give_void_volumes(&how, &network, &reason);
    if (status) die(status, "%s: %s", input_name(input->path), reason.text);

    char model[700], bounded[300];
    snprintf(model, sizeof model,
             "%s diagram%s, %s\n"
             "throat radius: %s%s\n"
             "throat volume: %s\n"
             "conductance: %s\n"
             "%d throats without clearance, %d grains without a cell\n"
             "left out: boundary layer\n",
             how.power ? "power" : "Voronoi",
             how.layer ? " of a layer, staggered against its grains" : "",
             bounding(&packing, how.boundary, bounded),
             how.entry ? "" : "least clearance from ",
             how.entry ? "that of the pressure at which gas enters"
                       : radius_rule[how.clearance],
             parameters.volume == VOLUME_VOID ? "its share of the void"
                                              : "the cylinder of its radius and length",
             how.shapes ? "the open section between the grains"
                        : "the cylinder of radius and length",
             report.n_closed, packing.n_particle - report.n_cell);
    write_network(&network, &invocation, input, model);

    artifact_close(input);
    packing_free(&packing);
    network_free(&network);
    invocation_free(&invocation);
    return STATUS_OK;
}
