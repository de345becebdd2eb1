// SPDX-License-Identifier: GPL-3.0-or-later
// Grains that came loose, for the explicit engine: those of fragments (fragments.h)
// without a held grain. Nothing balances the net load of such a fragment: as long as it
// lasts the fragment accelerates, and breaks what it meets, so that cracks would count
// time steps. loose_grains=unload takes that net load off (inertia relief) and brings
// the fragment to rest. A single grain then carries nothing; a larger fragment keeps
// the part of its load that balances itself, and may crack on.
#ifndef CRAQUELURE_LOOSE_H
#define CRAQUELURE_LOOSE_H

#include "dem/dem.h"
#include "geometry/fragments.h"
#include "geometry/net_load.h"
#include "geometry/packing.h"

struct loose_grains {
    struct fragments fragments;
    bool *is_loose;         // (n_particle) 0 or 1
    int n_loose, first_one; // how many, and the lowest of them
};

struct loose_grains loose_make(int n_particle);
void loose_free(struct loose_grains *loose);

// How things are now. HELD (n_particle) grains are fixed; where there is none the
// largest fragment counts as held. Depends on the intact bonds of DEM only. O(grains +
// bonds).
void find_loose(struct loose_grains *loose, const struct packing *packing,
                const uint8_t *held, const struct dem *dem);

// Takes the net load off every loose fragment where DISPLACEMENT, in m (n_particle),
// has brought it, as take_off_net_load does, so that FORCE, in N (n_particle), is left
// with what balances itself in each. Returns the sum of what was taken off. O(grains).
struct net_load relieve_loose(const struct loose_grains *loose,
                              const struct packing *packing,
                              const struct vector *displacement, struct vector *force);

#endif
