// SPDX-License-Identifier: GPL-3.0-or-later
// Walls as mirrors: a grain reflected in a wall shares with its image exactly that wall
// as the face between them, so the diagram of the grains and their images, looked at
// from the grains alone, is the diagram cut by the box (truncation strategy, K 3.3.1),
// and border throats meet the wall at right angles.
#ifndef CRAQUELURE_MIRRORED_H
#define CRAQUELURE_MIRRORED_H

#include "basics/status.h"
#include "geometry/packing.h"

#include <stdbool.h>

// Generators of the diagram, in units of the mean grain diameter from the lower corner
// of the box: first the grains, then images.
struct generators {
    int n, n_particle;
    struct vector *position;
    double *weight;    // radius squared; 0 for Voronoi
    int32_t *particle; // the grain itself, or that an image belongs to
    int8_t *wall;      // -1 for a grain, else 0..5 the wall it is reflected in
    struct vector box; // upper corner
    double unit;       // m
};

// Grains, and images of those within REACH (mean diameters) of a wall. Positions are
// rounded to 2^-40 of the diameter: what is degenerate but for rounding errors (a
// lattice) becomes exactly so, and the exact predicates then make no slivers of the
// noise. STATUS_BAD_DATA when a grain's centre is outside the box or on a wall.
enum status mirror_grains(const struct packing *packing, double reach, bool power,
                          struct generators *generators, struct reason *reason);
void generators_free(struct generators *generators);

// The unit of length, m.
double mean_diameter(const struct packing *packing);

#endif
