// SPDX-License-Identifier: GPL-3.0-or-later
// Runs and their drying out of artifacts; these end the program where what a schema
// cannot say is wrong: a bond that breaks twice or after the end, a drying of no step.
#ifndef CRAQUELURE_CRACKSTATS_READ_H
#define CRAQUELURE_CRACKSTATS_READ_H

#include "artifacts/artifact.h"
#include "liquid.h"
#include "run.h"

struct run read_run(const struct artifact *response);     // freed with run_free
struct liquid read_liquid(const struct artifact *drying); // with liquid_free

#endif
