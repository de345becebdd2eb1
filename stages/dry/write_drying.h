// SPDX-License-Identifier: GPL-3.0-or-later
// The drying artifact.
#ifndef CRAQUELURE_WRITE_DRYING_H
#define CRAQUELURE_WRITE_DRYING_H

#include "artifacts/artifact.h"
#include "parameters.h"

// HISTORY of the whole run on NETWORK, as PARAMETERS asked for it, with the boundary
// layer that TRANSFER made; to the output of INVOCATION. INPUT is the network artifact.
void write_drying(const struct network *network, const struct drying_history *history,
                  const struct invocation *invocation, const struct artifact *input,
                  const struct dry_parameters *parameters,
                  const struct mass_transfer *transfer);

#endif
