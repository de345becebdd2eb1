// SPDX-License-Identifier: GPL-3.0-or-later
// The pressure at which gas enters throats and nodes.
#pragma once

#include "network/invasion.h"

struct entry_conditions {
    double surface_tension; // N/m, above 0
    double contact_angle;   // degrees, from 0 to below 90
    double liquid_density;  // kg/m3, above that of the gas
    double gravity;         // towards -z, m/s2; 0: none
};

// A node is as wide as its widest throat.
struct entry {
    int n;            // throats, or nodes
    double *pressure; // (n) Pa, of the gas above that of the liquid at the box's floor
    double *
        entry_priority; // (n) for invade: radii without gravity, so that equal ones tie
};

// The pressure is 2 sigma cos(theta) / r - rho g z with z above the lower side of the
// box: gas from above is stabilised by gravity, gas from below is destabilised. The
// caller frees ENTRY with entry_free, also after a failure.
//
// STATUS_BAD_DATA with the dataset, the row, the rule and the value: a throat of kind
// THROAT_NETWORK without radius or with less than no volume, or none of that kind; or
// gravity along an axis on which the box repeats.
enum status entry_init(const struct network *network, enum invasion_rule rule,
                       const struct entry_conditions *conditions, struct entry *entry,
                       struct reason *reason);

void entry_free(struct entry *entry);
