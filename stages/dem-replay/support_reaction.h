// SPDX-License-Identifier: GPL-3.0-or-later
// The reaction of the supports: fixed grains, and the wall beneath. Both engines give
// it in the same terms: all that the supports do to the grains, of which each fixed
// grain's own load is a part. O(n_particle).
#pragma once

#include "geometry/net_load.h"
#include "quasi_static/quasi_static.h"

// Force (N) on the grains and moment (N m) about the lower corner of the box, in the
// last cycle, or in the last equilibrium under FORCE (n_particle). Reaction and load
// together are the rate of change of the grains' momentum, 0 at rest. HELD
// (n_particle): 1 for fixed grains.
struct net_load reaction_of_dem(const struct packing *packing, const struct dem *dem,
                                const uint8_t *held, bool has_wall);

// FORCE is the load of that equilibrium: what acts on fixed grains goes to the supports
// without passing through it.
struct net_load reaction_of_equilibrium(const struct packing *packing,
                                        const struct quasi_static *equilibrium,
                                        const uint8_t *held,
                                        const struct vector *force);
