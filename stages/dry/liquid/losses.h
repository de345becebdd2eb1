// SPDX-License-Identifier: GPL-3.0-or-later
// Which throats of viscous liquid lose it while the gas stays as it is, and how fast.
#ifndef CRAQUELURE_LOSSES_H
#define CRAQUELURE_LOSSES_H

#include "occupancy.h"
#include "viscous.h"

struct loss {
    int throat;
    double rate; // of scaled volume; below 0: it fills
};

struct losses {
    int n;
    struct loss *loss; // (n) ascending throats
    // Workspace, all zero between calls.
    double *evaporation; // (n_throat) what each throat is charged with
    int n_evaporating;
    int *evaporating; // (n_evaporating) throats
};

// Room for N_THROAT throats. The caller frees it with losses_free.
struct losses losses_make(int n_throat);

// Shares what the wet nodes evaporate among the throats with liquid beside them, in
// proportion to their cross-sections, and finds with FLOW which throats it empties.
enum status losses_find(struct losses *losses, struct occupancy *occupancy,
                        struct liquid_flow *flow, struct reason *reason);

// By throats, ascending.
void losses_sort(struct losses *losses);

// Proportional to the cross-section of THROAT; 0 if it holds no liquid.
double liquid_section(const struct occupancy *occupancy, int throat);

void losses_free(struct losses *losses);

#endif
