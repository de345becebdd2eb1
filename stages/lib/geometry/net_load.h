// SPDX-License-Identifier: GPL-3.0-or-later
// What would move an aggregate that nothing holds as one, and how it is taken off. The
// liquid in a free body pulls its grains against each other, so its net load is
// rounding and the errors of a model; with nothing to hold the body even that would
// accelerate it away.
#pragma once

#include "geometry/packing.h"

// N, and N m about the lower corner of the box; the moment means nothing where the box
// repeats. As loads on the grains.
struct net_load {
    struct vector force, moment;
};

// Grains on their way; of one density.
struct moving_grains {
    const struct vector *displacement;    // (n_particle) m
    const struct vector *velocity, *spin; // (n_particle) m/s, rad/s; NULL: at rest
    double density;                       // kg/m3
    double time; // s, > 0: within which motion as one is stopped
};

// Takes off what would move the grains as one: from every grain, by its mass, the one
// acceleration and the one angular acceleration that leave FORCE, in N (n_particle),
// without net force and net moment where the grains are NOW (NULL: where they began, at
// rest), and that stop what they have of such motion. Those that ARE GONE (NULL: none)
// have no mass. Grains turn about the centre of mass as points; not about an axis
// across which the box repeats. Returns what was taken off, but for what stops.
// O(n_particle). FORCE is changed in place.
struct net_load take_off_net_load(const struct packing *packing, const bool *is_gone,
                                  const struct moving_grains *now,
                                  struct vector *force);

// Puts LOAD on the grains as one: an acceleration and an angular acceleration, by mass,
// of those that ARE GONE (NULL) none, where they were moved by DISPLACEMENT (NULL:
// not).
void put_on_net_load(const struct packing *packing, const bool *is_gone,
                     const struct vector *displacement, struct net_load load,
                     struct vector *force);

// Grains as one body. Masses in units of the first grain's, lengths of its radius, from
// the lower corner of the box: no large numbers.
struct whole {
    const struct packing *packing;
    const bool *is_gone;               // NULL: none is
    const struct vector *displacement; // (n_particle) m, kept, not copied; NULL: none
    double length, mass;               // unit, and sum
    struct vector centre;              // of mass
    struct vector inertia[3];          // rows of the tensor about it
};

// What belongs to the grains that are not gone, where DISPLACEMENT has moved them. A
// value: nothing to free.
struct whole whole_of(const struct packing *packing, const bool *is_gone,
                      const struct vector *displacement);
double whole_mass(const struct whole *whole, int grain);         // 0 if it is gone
struct vector whole_place(const struct whole *whole, int grain); // from the centre

// What MOMENT turns the grains with, by the principal axes of the inertia: nothing
// about an axis across which the box repeats, nor for grains in a line about that. It
// is the pseudo-inverse of the inertia tensor times MOMENT, in the units of WHOLE.
struct vector whole_turn(const struct whole *whole, struct vector moment);
