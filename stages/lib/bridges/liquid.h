// SPDX-License-Identifier: GPL-3.0-or-later
// Which pairs of grains hold a liquid bridge, how much is in each, and how it pulls:
// what discrete elements ask [G 2]. A bridge forms when two grains touch and lasts
// until it ruptures.
#ifndef CRAQUELURE_LIQUID_H
#define CRAQUELURE_LIQUID_H

#include "bridges/bridges.h"

#include <stdbool.h>

enum liquid_sharing {
    LIQUID_FIXED, // each bridge holds the same volume [G 4.1]; liquid is not conserved
    LIQUID_SHARED // each grain parts its own volume evenly among its bridges
};

struct liquid {
    enum liquid_sharing sharing;
    enum bridge_model model; // not BRIDGE_EXACT, not BRIDGE_TABLE
    double surface_tension;  // N/m
    double contact_angle;    // rad
    double volume;           // m3: of each bridge, or on each grain
    bool pulls_in_contact;   // false: only apart [G 4]; true: also in overlap
    int *bridges;            // of each grain
};

// Grains without bridges. Owns .bridges until liquid_free.
struct liquid liquid_create(const struct liquid *like, int n_grain);
void liquid_free(struct liquid *liquid);

// Volume (m3) of a bridge between grains I and J, as bridges now are.
double liquid_volume(const struct liquid *liquid, int i, int j);

// Whether I and J, of these radii (m), are bridged at SEPARATION (m), given whether
// they WERE; counts it. With LIQUID_SHARED volumes follow the counts, so visit all
// pairs, in any fixed order, before asking for forces.
bool liquid_bridged(struct liquid *liquid, int i, int j, const double radius[2],
                    double separation, bool were);

// How the bridge between I and J pulls (N).
double liquid_force(const struct liquid *liquid, int i, int j, const double radius[2],
                    double separation);

#endif
