// SPDX-License-Identifier: GPL-3.0-or-later
// What would move an aggregate that nothing holds as one, and how it is taken off.
#ifndef CRAQUELURE_NET_LOAD_H
#define CRAQUELURE_NET_LOAD_H

#include "geometry/packing.h"

// N, and N m about the lower corner of the box; the moment means nothing where the box
// repeats.
struct net_load {
    struct vector force, moment;
};

// Grains on their way; of one density.
struct moving_grains {
    const struct vector *displacement;    // (n_particle) m
    const struct vector *velocity, *spin; // (n_particle) m/s, rad/s
    double density;                       // kg/m3
    double time; // s, > 0: within which motion as one is stopped
};

// Takes off what would move the grains as one: from every grain, by its mass, the one
// acceleration and the one angular acceleration that leave FORCE, in N (n_particle),
// without net force and net moment where the grains are NOW (NULL: where they began, at
// rest), and that stop what they have of such motion. Those that ARE GONE (NULL: none)
// have no mass. Grains turn about the centre of mass as points; not about an axis
// across which the box repeats. Returns what was taken off, but for what stops.
struct net_load take_off_net_load(const struct packing *packing, const bool *is_gone,
                                  const struct moving_grains *now,
                                  struct vector *force);

#endif
