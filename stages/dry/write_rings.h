// SPDX-License-Identifier: GPL-3.0-or-later
// What became of rings, in the drying artifact.
#ifndef CRAQUELURE_WRITE_RINGS_H
#define CRAQUELURE_WRITE_RINGS_H

#include "artifacts/artifact.h"
#include "dry/run/drying.h"

// HISTORY->rings must be there.
void put_rings(struct artifact *artifact, const struct drying_history *history);

#endif
