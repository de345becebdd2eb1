// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary layer in a drying artifact: datasets and lines of its description.
//
//     /boundary_layer  node, wall, area m2 (n_column);
//                      links (n_link, 2), length m, width m, edge (n_link)
//     /summary         boundary_layer_thickness m, boundary_layers
#pragma once

#include "artifacts/artifact.h"
#include "dry/gas/mass_transfer.h"
#include "dry/run/drying.h"

// Writes its columns, their exchange areas and links to ARTIFACT, in metres, as
// dry_network had them. Ends the program on failure. NETWORK and CONDITIONS must be
// those of the run. The layer is made again, since the run keeps only its scaled one.
void put_boundary_layer(struct artifact *artifact, const struct network *network,
                        const struct drying_conditions *conditions,
                        const struct drying_history *history);

// Lines of `model`, written to TEXT, which they return: how the layer is modelled, and
// where its thickness comes from. Without a line's end.
const char *describe_layer(const struct drying_conditions *conditions,
                           const struct drying_history *history, char text[300]);
const char *describe_flow(enum transfer_law law, const struct mass_transfer *transfer,
                          char text[200]);
