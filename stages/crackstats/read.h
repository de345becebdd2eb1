// SPDX-License-Identifier: GPL-3.0-or-later
// Reads runs and their drying from artifacts. They end the program if something is
// wrong that a schema cannot express: a bond that breaks twice or after the end, a
// drying without a step.
#ifndef CRAQUELURE_CRACKSTATS_READ_H
#define CRAQUELURE_CRACKSTATS_READ_H

#include "artifacts/artifact.h"
#include "liquid.h"
#include "run.h"

struct run read_run(const struct artifact *response);     // freed with run_free
struct liquid read_liquid(const struct artifact *drying); // with liquid_free

#endif
