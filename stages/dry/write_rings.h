// SPDX-License-Identifier: GPL-3.0-or-later
// What became of rings, in the drying artifact.
#pragma once

#include "artifacts/artifact.h"
#include "dry/run/drying.h"

// HISTORY->rings must be there. Writes /rings, /ring_changes, /history/ring_saturation
// and, with films, what they did; volumes in m3. ARTIFACT is a drying; the caller
// finishes it.
void put_rings(struct artifact *artifact, const struct drying_history *history);
