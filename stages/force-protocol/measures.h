// SPDX-License-Identifier: GPL-3.0-or-later
// What is said of the forces of a protocol, found time by time.
#pragma once

#include "geometry/packing.h"

// Largest values over all times so far; all 0 before the first.
struct measures {
    double force, change;   // N: on a grain, and from one time to the next
    double sum, moment;     // N, N m: of all forces, about the middle of the box
    double forces, moments; // N, N m: sums of the magnitudes of their parts
};

// Takes the forces of the next time into account (n_particle) N, and those of the time
// before; NULL at the first. O(n_particle).
void measure_forces(struct measures *measures, const struct packing *packing,
                    const struct vector *force, const struct vector *former);

// The largest net force, and net moment about the middle of the box, at any time, each
// relative to the largest sum of magnitudes of its parts. In a periodic box the moment
// is not defined: 0.
double net_force(const struct measures *measures);
double net_moment(const struct measures *measures, const struct packing *packing);
