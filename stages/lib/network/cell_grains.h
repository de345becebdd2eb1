// SPDX-License-Identifier: GPL-3.0-or-later
// The grains in the units of the computation, and their copies in a periodic box. The
// unit of length is the cube root of the box volume per grain, so that all that follows
// is of the order of 1, whatever the size of the grains.
#pragma once

#include "basics/status.h"
#include "geometry/image.h"
#include "geometry/packing.h"

// Lengths in units from the lower corner of the box. Grain i of the packing is base i;
// its copies come after all grains.
struct grains {
    int n, n_base;
    struct vector *position; // (n)
    double *weight;          // (n) radius squared
    double *radius;          // (n_base)
    int32_t *base;           // (n) the grain that this one is a copy of
    struct image *image;     // (n) how many boxes away from it
    struct vector box;       // upper corner
    bool repeats[3];
    double reach; // copies are made up to here beyond the sides that repeat
    double unit;  // m
};

// Grains of PACKING with copies as far as REACH units. Positions and box are rounded to
// 2^-40 units (or coarser in a box of more than 2^10 units): lattices become exact, and
// so do copies. STATUS_BAD_DATA when there is no grain, a centre is not inside the
// walls, or there are walls besides those of the box.
enum status place_grains(const struct packing *packing, double reach,
                         struct grains *grains, struct reason *reason);
// Frees what the grains own, and empties them.
void grains_free(struct grains *grains);

// POSITION moved by whole boxes.
struct vector in_image(const struct grains *grains, struct vector position,
                       struct image image);

// Whether any direction repeats.
bool grains_repeat(const struct grains *grains);
