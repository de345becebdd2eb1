// SPDX-License-Identifier: GPL-3.0-or-later
// What holds a body: grains at walls of the box, and those that bonds join to them.
#pragma once

#include "geometry/packing.h"

#include <stdbool.h>
#include <stdint.h>

// Whether GRAIN touches one of WALLS (bit k: wall k of the box), to 1e-6 of its radius,
// or reaches beyond it. Where the box repeats there are no walls: leave the bits out.
bool touches_walls(const struct packing *packing, int grain, unsigned walls);

// The lowest grain of those that bonds join to each grain, itself included: equal for
// two grains of one piece. All bonds of the packing count as intact. (n_particle); the
// caller frees it. O(n_particle + n_bond), nearly.
int *bonded_pieces(const struct packing *packing);

// How many grains bonds join to those marked in HOLDS (n_particle), these included.
int count_supported(const struct packing *packing, const uint8_t *holds);
