// SPDX-License-Identifier: GPL-3.0-or-later
// Grains that came loose, for the explicit engine: those of fragments (fragments.h)
// without a held grain. Nothing balances the pull of liquid on them: as long as it
// lasts they accelerate, and break what they meet, so that cracks would count time
// steps. With loose_grains=unload their loads end as they come loose, and they are
// brought to rest.
#ifndef CRAQUELURE_LOOSE_H
#define CRAQUELURE_LOOSE_H

#include "dem/dem.h"
#include "fragments.h"
#include "geometry/packing.h"

struct loose_grains {
    struct fragments fragments;
    bool *is_loose;         // (n_particle) 0 or 1
    int n_loose, first_one; // how many, and the lowest of them
};

struct loose_grains loose_new(int n_particle);
void loose_free(struct loose_grains *loose);

// How things are now. HELD (n_particle) grains are fixed; where there is none the
// largest fragment counts as held. Depends on the intact bonds of DEM only. O(grains +
// bonds).
void find_loose(struct loose_grains *loose, const struct packing *packing,
                const uint8_t *held, const struct dem *dem);

#endif
