// SPDX-License-Identifier: GPL-3.0-or-later
// Cracks that opened under loads that did not come to rest: those might be others with
// more cycles or a shorter step.
#ifndef CRAQUELURE_CRACKSTATS_UNSETTLED_H
#define CRAQUELURE_CRACKSTATS_UNSETTLED_H

#include "run.h"

// The loads of a replay, in their order.
struct loads {
    int n;
    const double *time;     // (n) s, increasing
    const uint8_t *settled; // (n) 1: came to rest
};

// Cracks of RUN under loads that are not settled. Its cracks must be in order of time,
// none later than the last load. O(cracks + loads).
int unsettled_cracks(const struct run *run, const struct loads *loads);

#endif
