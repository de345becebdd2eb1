// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the drying artifact (schemas/drying.json).
#pragma once

#include "artifacts/artifact.h"
#include "parameters.h"

// Writes HISTORY of the whole run on NETWORK under PARAMETERS to the output of
// INVOCATION. NETWORK is that of the run, with the radii that were drawn and the
// throats that were shut. TRANSFER made the boundary layer; INPUT is the artifact that
// was read, a network or a drying, for the provenance. SI units. Ends the program on
// failure, also if there are more changes than a dataset can have rows. The history is
// not changed, and must have its first and last step.
void write_drying(const struct network *network, const struct drying_history *history,
                  const struct invocation *invocation, const struct artifact *input,
                  const struct dry_parameters *parameters,
                  const struct mass_transfer *transfer);
