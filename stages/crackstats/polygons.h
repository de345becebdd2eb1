// SPDX-License-Identifier: GPL-3.0-or-later
// A layer parted into polygons by crack columns (docs/craquelure.md).
#pragma once

#include "columns.h"

// It owns its arrays; freed with polygons_free. Without a pattern NONE says why, and
// what follows it is 0 or NULL; but where no piece was large enough for a polygon LABEL
// is there, -1 throughout.
struct polygons {
    double threshold;  // damage of a crack column
    double percentile; // the 98th, of the damage
    double crack_area; // crack columns over all
    double in_cracks;  // of the broken lateral bonds: those in crack columns
    const char *none;  // why there is no pattern; NULL: there is one
    int count;         // polygons
    int *label;        // (columns.n) polygon, -1: crack column or a crumb
    int *nearest;      // (columns.n) polygon that the column, cracks too, counts to
    double *area;      // (count) m2, cracks divided among them
    double border;     // length of the borders between different polygons, m
    double through;    // of the crack columns: those in sets that cut all heights
};

// DAMAGE (columns.n) of the bonds not INTACT.
struct polygons find_polygons(const struct columns *columns, const struct run *run,
                              const uint8_t *intact, const double *damage);
void polygons_free(struct polygons *polygons);

// Components of core grains, which are not held and keep at least 0.6 of their lateral
// bonds, by the bonds between them, of at least h^3 / 2 d^3 grains.
int count_islands(const struct columns *columns, const struct run *run,
                  const uint8_t *intact);
