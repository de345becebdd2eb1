// SPDX-License-Identifier: GPL-3.0-or-later
// Reads runs and their drying from artifacts. They end the program if something is
// wrong that a schema cannot express: a bond that breaks twice or after the end, a
// drying without a step.
#pragma once

#include "artifacts/artifact.h"
#include "liquid.h"
#include "run.h"

// Reads a response of dem-replay with its packing, cracks, loads and snapshots. The
// program ends with status 65 if a bond breaks twice, if a crack is later than the last
// load, or if the response says that loads did not settle but not which. The caller
// frees it with run_free.
struct run read_run(const struct artifact *response);

// Reads the network and the history of a drying, which must have a step (else status
// 65). The caller frees it with liquid_free.
struct liquid read_liquid(const struct artifact *drying);
