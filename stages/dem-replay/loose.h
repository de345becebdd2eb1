// SPDX-License-Identifier: GPL-3.0-or-later
// Loose grains, for the explicit engine: those of fragments (fragments.h) without a
// fixed grain. Nothing balances the net load of such a fragment: while it lasts the
// fragment accelerates and breaks what it meets, so that cracks would count time steps.
// loose_grains=unload removes the net load (inertia relief) and stops the fragment. A
// single grain then carries no load; a larger fragment keeps the part of its load that
// is in equilibrium, and may crack further.
#pragma once

#include "dem/dem.h"
#include "geometry/fragments.h"
#include "geometry/net_load.h"
#include "geometry/packing.h"

// The axes along which a fragment is joined to an image of itself.
struct repeats {
    uint8_t along[3];
};

struct loose_grains {
    struct fragments fragments;
    bool *is_loose; // (n_particle) 0 or 1
    int n_loose;
    struct vector *place; // (n_particle) m, of the packing, each loose fragment in one
                          // piece where the box repeats
    struct repeats *repeats; // (n_particle) of a loose fragment, by its lowest grain
};

struct loose_grains loose_init(int n_particle);
void loose_free(struct loose_grains *loose);

// Finds the loose grains of now. HELD (n_particle) grains are fixed; if there are none
// the largest fragment counts as fixed. Depends only on the intact bonds of DEM.
// O(grains + bonds).
void find_loose(struct loose_grains *loose, const struct packing *packing,
                const uint8_t *held, const struct dem *dem);

// Removes the net load of every loose fragment from FORCE (n_particle, N), at its place
// after DISPLACEMENT (n_particle, m), as take_off_net_load does. Returns the sum of the
// loads removed. O(grains).
struct net_load relieve_loose(const struct loose_grains *loose,
                              const struct packing *packing,
                              const struct vector *displacement, struct vector *force);
