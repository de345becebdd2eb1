// SPDX-License-Identifier: GPL-3.0-or-later
// Which throats lose liquid while the gas stays as it is, and how fast: where one limit
// of the liquid's mobility differs from another.
#ifndef CRAQUELURE_LOSSES_H
#define CRAQUELURE_LOSSES_H

#include "drying.h"
#include "phases.h"

struct loss {
    int throat;
    double rate; // of scaled volume
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
// proportion to their cross-sections, and finds by LIMIT which throats it empties.
void losses_find(struct losses *losses, struct phases *phases, enum liquid_limit limit);

void losses_free(struct losses *losses);

#endif
