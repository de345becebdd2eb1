// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary layer is made again, in metres, since the run keeps only its scaled one.
// Same network, same walls, same thickness and number of layers: boundary_layers_init
// then gives the same columns, with a unit of length of 1 m.
#include "write_layer.h"

#include "basics/status.h"

#include <stdio.h>

// It cannot fail where the run did not.
void put_boundary_layer(struct artifact *artifact, const struct network *network,
                        const struct drying_conditions *conditions,
                        const struct drying_history *history)
{
    const struct boundary_form form = {conditions->feet, history->boundary_layers,
                                       conditions->lumped};
    struct boundary_layer layer;
    struct reason reason;
    const enum status status =
        boundary_layers_init(network, conditions->open_walls, 1,
                             history->boundary_layer_thickness, &form, &layer, &reason);
    if (status) die(status, "%s", reason.text);
    artifact_put(artifact, "/boundary_layer/node", layer.exposed, layer.n_exposed);
    artifact_put(artifact, "/boundary_layer/wall", layer.wall, layer.n_exposed);
    artifact_put(artifact, "/boundary_layer/area", layer.area, layer.n_exposed);
    artifact_put(artifact, "/boundary_layer/links", layer.lateral, layer.n_lateral);
    artifact_put(artifact, "/boundary_layer/length", layer.lateral_length,
                 layer.n_lateral);
    artifact_put(artifact, "/boundary_layer/width", layer.lateral_width,
                 layer.n_lateral);
    artifact_put(artifact, "/boundary_layer/edge", layer.lateral_edge, layer.n_lateral);
    artifact_put_number(artifact, "/summary/boundary_layer_thickness",
                        history->boundary_layer_thickness);
    artifact_put_number(artifact, "/summary/boundary_layers", layer.layers);
    boundary_layer_free(&layer);
}

const char *describe_layer(const struct drying_conditions *conditions,
                           const struct drying_history *history, char text[300])
{
    const char *feet = conditions->feet == FEET_SURFACE
                           ? "all nodes of the surface"
                           : "the nodes of the auxiliary layer";
    if (conditions->lumped)
        snprintf(text, 300, "lumped, %s exchange with the air one by one", feet);
    else
        snprintf(text, 300, "%d layers of columns on %s, lateral diffusion included%s",
                 history->boundary_layers, feet,
                 __builtin_popcount(conditions->open_walls) > 1
                     ? ", not around the edges between open walls"
                     : "");
    return text;
}

// In the order of enum transfer_law. Numbers only where the law used them.
const char *describe_flow(enum transfer_law law, const struct mass_transfer *transfer,
                          char text[200])
{
    static const char *const name[] = {"the mass transfer coefficient",
                                       "the thickness given", "the Sherwood number",
                                       "laminar flow along a plate [K 3.6]",
                                       "flow around a sphere [Ranz and Marshall]"};
    const char *from = name[law];
    if (law < TRANSFER_PLATE)
        snprintf(text, 200, "%s", from);
    else
        snprintf(text, 200, "%s: Re = %.6g, Sc = %.6g, Sh = %.6g", from,
                 transfer->reynolds, transfer->schmidt, transfer->sherwood);
    return text;
}
