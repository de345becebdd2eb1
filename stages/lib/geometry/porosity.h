// SPDX-License-Identifier: GPL-3.0-or-later
// How much of a packing is solid, and where. What two grains share counts once, pair by
// pair: exact as long as no three grains share anything.
#pragma once

#include "geometry/packing.h"

#include <stdbool.h>

// The touching grains, as neighbour_pairs gives them.
struct contacts {
    int count;
    const int32_t (*pair)[2]; // (count)
};

// A part of the box of a packing.
struct window {
    struct vector lower, upper; // m
};

// Whether the grains are one layer: all centres have the same y, to the last digit, and
// the box, which does not repeat along y, is thinner than two of the largest grains.
bool packing_is_flat(const struct packing *packing);

// Mean radius, m; 0 when there is no grain.
double mean_radius(const struct packing *packing);

// The box without one mean diameter along every wall: not where it repeats, nor along y
// when the packing is flat. False when nothing is left. Bodies are not looked at: for
// round domains the caller takes another window (pack/report.c).
bool inner_window(const struct packing *packing, struct window *window);

// Volume of all grains, wherever they are, less the lenses that CONTACTS share, m^3.
// O(grains + contacts). Grains that stick out of the box count whole.
double solid_volume(const struct packing *packing, const struct contacts *contacts);

// Void share of COUNT slices of equal thickness along z, in a window; 1 slice: of the
// window. Where the box repeats the window must span it. POROSITY has COUNT values.
// Grains are cut by the slices and, along axes that do not repeat, by the sides of the
// window. O(slices that each grain reaches, summed).
void slice_porosity(const struct packing *packing, const struct contacts *contacts,
                    const struct window *window, int count, double *porosity);
