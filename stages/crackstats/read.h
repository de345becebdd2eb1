// SPDX-License-Identifier: GPL-3.0-or-later
// Runs and their drying out of artifacts.
#ifndef CRAQUELURE_CRACKSTATS_READ_H
#define CRAQUELURE_CRACKSTATS_READ_H

#include "artifacts/artifact.h"
#include "liquid.h"
#include "run.h"

struct run read_run(const struct artifact *response);
struct liquid read_liquid(const struct artifact *drying);

#endif
