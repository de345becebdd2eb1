// SPDX-License-Identifier: GPL-3.0-or-later
// Invasion percolation by itself (Wilkinson & Willemsen 1983): gas comes in through
// walls, and at each step enters the easiest throat, or node, that it touches. What is
// entered when, and without clocks, vapour or viscosity what that leaves behind.
//
//     struct invasion_conditions conditions = {.rule = INVADE_THROATS,
//                                              .inlet = WALL_Z_UPPER,
//                                              .outlet = WALL_Z_LOWER,
//                                              .trapping = true};
//     struct invasion invasion;
//     enum status status = invade(&network, &conditions, &invasion, &reason);
//     for (int k = 0; k < invasion.n; k++)
//         gas enters throat invasion.throat[k] and comes to node invasion.node[k];
//     invasion_free(&invasion);
// Without gravity a throat of radius r opens at the pressure 2 sigma cos(theta) / r, so
// the order is that of rising pressures only as far as gas can reach: the k-th event
// may need less than one before.
#pragma once

#include "basics/status.h"
#include "network/network.h"

#include <stdbool.h>

enum invasion_rule {
    INVADE_THROATS, // throats hold gas up, nodes do not; those on the inlet begin dry
    INVADE_NODES // nodes hold gas up, throats do not; those on the inlet are in touch
};

struct invasion_conditions {
    enum invasion_rule rule;
    // (n_throat, or n_node) What is larger is entered first, of equals as
    // network/entry_order.h says. NULL: the radii of the throats.
    const double *entry_priority;
    unsigned inlet, outlet; // bits of enum wall
    // Liquid leaves only through the outlet: what gas has cut off from it stays.
    bool trapping;
    bool until_breakthrough; // ends when gas first touches the outlet
};

struct invasion {
    int n;            // events
    int32_t *throat;  // (n) the throat that gas enters; NULL where it enters nodes
    int32_t *node;    // (n) the node that it comes to; -1: it was at both ends already
    int breakthrough; // events when gas first touches the outlet, that one included; -1
};

// Throats of kind THROAT_NETWORK only. The order with trapping is that without less
// what was trapped, which is found backwards (Masson
// 2016, 10.1016/j.cageo.2016.02.003): liquid returns to the nodes from the last to the
// first. O(n) for n throats, but for what a union-find adds. The caller frees with
// invasion_free, also after a failure.
//
// STATUS_BAD_DATA if a wall has no throat.
enum status invade(const struct network *network,
                   const struct invasion_conditions *conditions,
                   struct invasion *invasion, struct reason *reason);

void invasion_free(struct invasion *invasion);
