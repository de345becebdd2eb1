// SPDX-License-Identifier: GPL-3.0-or-later
// A packing of spherical grains in a box, with the bonds between them: what packing.h5
// holds, in memory.
#ifndef CRAQUELURE_PACKING_H
#define CRAQUELURE_PACKING_H

#include "geometry/vector.h"

#include <stdbool.h>
#include <stdint.h>

// The six walls of the box, as bits (a node may lie on up to three) and in this order
// wherever walls are numbered.
enum wall {
    WALL_X_LOWER = 1,
    WALL_X_UPPER = 2,
    WALL_Y_LOWER = 4,
    WALL_Y_UPPER = 8,
    WALL_Z_LOWER = 16,
    WALL_Z_UPPER = 32
};
enum { WALL_COUNT = 6 };

struct packing {
    int n_particle;
    struct vector *position; // (n_particle) m
    double *radius;          // (n_particle) m
    struct vector lower;     // domain box, m
    struct vector upper;
    uint8_t periodic[3]; // 1 where the box repeats along x, y, z
    int n_bond;
    int32_t (*bond)[2]; // (n_bond) the two bonded grains, lower index first
};

// Whether the box repeats along any direction.
bool is_periodic(const struct packing *packing);

// Where wall 0..5 of the box stands along its axis, wall / 2; m.
double wall_position(const struct packing *packing, int wall);

// Frees what the packing owns and empties it; safe on an empty one.
void packing_free(struct packing *packing);

#endif
