// SPDX-License-Identifier: GPL-3.0-or-later
// Which throats lose liquid while the gas stays as it is, and how fast: where one limit
// of the liquid's mobility differs from another.
#ifndef CRAQUELURE_LOSSES_H
#define CRAQUELURE_LOSSES_H

#include "drying.h"
#include "phases.h"
#include "viscous.h"

struct loss {
    int throat;
    double rate; // of scaled volume; below 0: it fills
};

struct losses {
    int n;
    struct loss *loss; // (n) ascending throats
    // Workspace, all zero between calls.
    double *charge; // (n_throat) what each throat is charged with
    int n_charged;
    int *charged;         // (n_charged) throats
    double *cluster_rate; // (n_throat) what each cluster evaporates
};

struct losses losses_make(int n_throat);

// Shares what the wet nodes evaporate among the throats with liquid beside them, in
// proportion to their cross-sections, and finds by LIMIT which throats it empties. FLOW
// is used where the liquid is viscous; only then can it fail.
enum status losses_find(struct losses *losses, struct phases *phases,
                        enum liquid_limit limit, struct liquid_flow *flow,
                        struct reason *reason);

void losses_free(struct losses *losses);

#endif
