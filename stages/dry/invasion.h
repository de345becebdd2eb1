// SPDX-License-Identifier: GPL-3.0-or-later
// Invasion percolation by itself (Wilkinson & Willemsen 1983): gas comes in through
// walls, and at each step enters the widest throat it touches. Which throat when, and
// without clocks, vapour or clusters what that leaves behind.
#ifndef CRAQUELURE_INVASION_H
#define CRAQUELURE_INVASION_H

#include "basics/status.h"
#include "network/network.h"

#include <stdbool.h>

struct invasion {
    int n;            // throats invaded; those of kind THROAT_NETWORK only
    int32_t *throat;  // (n) in the order in which gas enters them
    int breakthrough; // throats when gas first touches the outlet, that one included;
                      // -1
};

// INLET and OUTLET are bits of enum wall. With TRAPPING the liquid leaves only through
// the outlet: what gas has cut off from it stays. That is the order without trapping
// less the trapped throats, found backwards (Masson 2016). Equal radii: the lowest
// index first. O(n) for n throats; the caller frees with invasion_free, also after a
// failure.
//
// STATUS_BAD_DATA if a wall has no throat.
enum status invade(const struct network *network, unsigned inlet, unsigned outlet,
                   bool trapping, struct invasion *invasion, struct reason *reason);

void invasion_free(struct invasion *invasion);

#endif
