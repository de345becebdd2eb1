// SPDX-License-Identifier: GPL-3.0-or-later
// What drying artifacts say of the boundary layer.
#ifndef CRAQUELURE_WRITE_LAYER_H
#define CRAQUELURE_WRITE_LAYER_H

#include "artifacts/artifact.h"
#include "dry/gas/mass_transfer.h"
#include "dry/run/drying.h"

// Its columns, their exchange areas and links, as dry_network had them.
void put_boundary_layer(struct artifact *artifact, const struct network *network,
                        const struct drying_conditions *conditions,
                        const struct drying_history *history);

// For the model, written to TEXT: how it is modelled, and what its thickness is from.
const char *describe_layer(const struct drying_conditions *conditions,
                           const struct drying_history *history, char text[300]);
const char *describe_flow(enum transfer_law law, const struct mass_transfer *transfer,
                          char text[200]);

#endif
