// SPDX-License-Identifier: GPL-3.0-or-later
// Aggregates of grains of many sizes at irregular places, bonded over small gaps.
#pragma once

#include "../random.h"
#include "geometry/packing.h"

// SIDE^3 grains of radii about SIZE, m, each as large as its nearest neighbour lets it
// be, in one piece; repeats along x and y if asked. To be freed with packing_free.
struct packing irregular_packing(int side, double size, bool repeats);

// The layer nearest to the lower z side. (n_particle); the caller frees it.
uint8_t *lowest_grains(const struct packing *packing, int side);

// The same grains turned by ANGLE about AXIS through the middle of the box, which grows
// to hold them, and numbered anew: grain i is ORDER[i] of the first. ORDER may be NULL.
struct packing turned_packing(const struct packing *packing, struct vector axis,
                              double angle, const int *order);
struct vector turned(struct vector a, struct vector axis, double angle);

// Forces towards the middle of the box, uneven, at most SIZE N. (n_particle)
struct vector *shrinking_load(const struct packing *packing, double size);
