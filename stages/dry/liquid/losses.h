// SPDX-License-Identifier: GPL-3.0-or-later
// Which throats of viscous liquid lose or gain it between two events, and how fast.
#pragma once

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
    double *evaporation; // (n_throat) what each throat evaporates
    int n_evaporating;
    int *evaporating; // (n_evaporating) throats
};

// Room for N_THROAT throats. The caller frees it with losses_free.
struct losses losses_init(int n_throat);

// Shares what the wet nodes evaporate among the throats with liquid beside them, in
// proportion to their cross-sections, and finds with FLOW the loss of each throat.
// STATUS_NOT_CONVERGED as liquid_flow_find. O(throats with liquid beside wet nodes),
// and the flow.
enum status losses_find(struct losses *losses, struct occupancy *occupancy,
                        struct liquid_flow *flow, struct reason *reason);

// Sorts the losses by throats, ascending.
void losses_sort(struct losses *losses);

// The weight of THROAT in the shares of a node: its volume over its length, which is
// proportional to its cross-section; 0 if it holds no liquid.
double liquid_section(const struct occupancy *occupancy, int throat);

// Their sum over the throats at NODE.
double liquid_sections_at(const struct occupancy *occupancy, int node);

void losses_free(struct losses *losses);
