// SPDX-License-Identifier: GPL-3.0-or-later
// The surfaces that a node of a network lies on: walls of the box, sides of bodies.
// Along each axis that a flat one holds, the node moves as that surface does; on a
// round one it may move along it; where nothing holds it, freely.
#pragma once

#include "geometry/packing.h"

struct domain_sides {
    bool held[3];   // along x, y, z: by a flat surface
    double step[3]; // how far that has moved, m
    int round;      // the body on whose round surface it is; -1: on none
};

// The sides of a node AT in WALLS (bits of enum wall, and of WALL_OUTER and WALL_INNER)
// of BEFORE, m; AFTER has the same surfaces where they are now. Walls 0..5 that the
// node only faces do not count; of WALL_OUTER and WALL_INNER the nearest side is taken
// in any case, so WALLS should have them only for nodes on a body.
struct domain_sides find_domain_sides(const struct packing *before,
                                      const struct packing *after, unsigned walls,
                                      struct vector at);
