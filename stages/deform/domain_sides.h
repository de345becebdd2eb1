// SPDX-License-Identifier: GPL-3.0-or-later
// The surfaces that a node of a network lies on: walls of the box, sides of bodies.
#ifndef CRAQUELURE_DEFORM_DOMAIN_SIDES_H
#define CRAQUELURE_DEFORM_DOMAIN_SIDES_H

#include "geometry/packing.h"

struct domain_sides {
    bool held[3];   // along x, y, z: by a flat surface
    double step[3]; // how far that has moved, m
    int round;      // the body on whose round surface it is; -1: on none
};

// The sides of a node AT in WALLS (bits of enum wall, and of WALL_OUTER and WALL_INNER)
// of BEFORE; AFTER has the same surfaces where they are now. Walls that the node only
// faces do not count.
struct domain_sides find_domain_sides(const struct packing *before,
                                      const struct packing *after, unsigned walls,
                                      struct vector at);

#endif
