// SPDX-License-Identifier: GPL-3.0-or-later
// Potentials of vapour (or of what else spreads in proportion to its fall) at every
// site: 1 in the air, 0 at sites that are held (wet), balanced at those that are free
// (dry), found by iteration from where it was last.
//
// What is left of the balances of free sites belongs to held sites or the air, nowhere
// else: each unit of it ends there, as a random walk does. So its sum of sizes bounds
// the errors of what held sites give off, added up (maximum principle).
#ifndef CRAQUELURE_POTENTIAL_H
#define CRAQUELURE_POTENTIAL_H

#include "multigrid.h"

struct potential {
    int n_site;
    struct multigrid grid; // by place, as all below
    double *air;           // (n_site) conductance to the air
    double *all;           // (n_site) all conductances
    double *value;         // (n_site)
    double *inflow;        // (n_site) at the last solution: given off where held
    double rate;           // given off in all, in second order: of all potentials that
                           // of the solution has the least energy
};

// All sites are held. AIR (n_site): conductances to it.
struct potential potential_make(int n_site, int n_link, const struct link *link,
                                const double *air);
void potential_free(struct potential *potential);

void potential_free_site(struct potential *potential, int site);

// Until what is left of the balances is LEAST in all, or less; false if it cannot be.
bool potential_solve(struct potential *potential, double least);

#endif
