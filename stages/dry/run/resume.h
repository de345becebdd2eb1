// SPDX-License-Identifier: GPL-3.0-or-later
// Runs that may be stopped and continued, to the same bytes.
#pragma once

#include "run.h"

// Asks KEEPER (may be NULL) whether the state of RUN should be kept, and keeps it;
// KEEPER may end the program. Viscous and Kelvin runs do so every 256 steps only, when
// all such runs forget what they keep for speed. Call it between two steps.
void keep_if_due(struct run *run, const struct keeper *keeper);

// Restores RUN, which was made for the start of the same network and conditions, from
// KEPT. STATUS_BAD_DATA: KEPT is not of such a run.
enum status go_on_from(struct run *run, const struct kept_state *kept,
                       struct reason *reason);
