// SPDX-License-Identifier: GPL-3.0-or-later
// What supports push back with: held grains, and the wall beneath.
#ifndef CRAQUELURE_SUPPORT_REACTION_H
#define CRAQUELURE_SUPPORT_REACTION_H

#include "geometry/net_load.h"
#include "quasi_static/quasi_static.h"

// On the grains, in the last cycle, or of the last equilibrium under FORCE
// (n_particle). With the load it is what the grains gain of momentum a second, so
// nothing at rest.
struct net_load reaction_of_dem(const struct packing *packing, const struct dem *dem,
                                const uint8_t *held, bool has_wall);
struct net_load reaction_of_equilibrium(const struct packing *packing,
                                        const struct quasi_static *equilibrium,
                                        const uint8_t *held,
                                        const struct vector *force);

#endif
