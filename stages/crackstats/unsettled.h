// SPDX-License-Identifier: GPL-3.0-or-later
// Cracks that opened under loads that did not come to rest: those might be others with
// more cycles or a shorter step.
#ifndef CRAQUELURE_CRACKSTATS_UNSETTLED_H
#define CRAQUELURE_CRACKSTATS_UNSETTLED_H

#include "run.h"

// The loads of a replay, in their order.
struct loads {
    int n;
    const double *time;       // (n) s, increasing
    const double *ratio;      // (n) unbalanced ratio at their ends [K 4.20]
    const double *saturation; // (n) of the network
    bool dry_is_loaded;       // something still pulls where no liquid is left
};

// Cracks of RUN under those N_UNSETTLED loads whose unbalanced ratio is largest. A step
// without a load, which cannot settle, is none of them.
int unsettled_cracks(const struct run *run, const struct loads *loads);

#endif
