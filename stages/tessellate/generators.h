// SPDX-License-Identifier: GPL-3.0-or-later
// The points of the diagram: grains, and images of those near the sides of the box.
//
// Walls are mirrors: a grain reflected in a wall shares with its image exactly that
// wall as the face between them, so the diagram of the grains and their images, looked
// at from the grains alone, is the diagram cut by the box (truncation strategy, K
// 3.3.1). Where the box repeats, both grains and reflections are copied beyond its
// sides (K 3.3.2).
//
// A round wall around the grains takes the place of those of the box that it touches.
// Each grain is reflected in a plane that is tangent to a slightly larger one: such
// images own nothing within the wall, and only close the cells beyond it, where
// cut_network cuts them.
#pragma once

#include "basics/status.h"
#include "geometry/image.h"
#include "geometry/packing.h"
#include "geometry/triangulation/exact.h"

#include <stdbool.h>

// Where a generator comes from.
struct origin {
    int32_t particle;   // the grain itself, or that an image belongs to
    int32_t base;       // the number of the base it is, or is a copy of
    struct image image; // how many boxes a copy is away from its base
    int8_t wall;        // 0..6 the wall it is reflected in; else -1
};

// In units of length from the lower corner of the box. Bases are the grains, numbered
// as in the packing, then their reflections; the others are copies of them. They stand
// in an order in which to insert them, so that what is close is close in memory.
struct generators {
    int n, n_particle, n_base, capacity;
    struct weighted_point *point; // weight: radius squared; 0 for Voronoi
    struct origin *origin;
    struct vector box; // upper corner
    bool repeats[3];
    bool walled[3];    // along which the box has two walls
    bool is_round;     // whether there is a round wall around the grains
    struct body round; // it
    double reach;      // images farther from the box are left out
    double largest_weight;
    double unit; // m
};

// Grains, and images of those within REACH (in units) of a side. Positions and box are
// rounded to 2^-42 of the mean diameter: what is degenerate but for rounding errors (a
// lattice) becomes exactly so, the exact predicates then make no slivers of the noise,
// and copies are exact. A grain outside the box along a direction that repeats is moved
// into it. STATUS_BAD_DATA when a grain's centre is outside the box, on a wall, or on
// the wrong side of a body. The caller frees GENERATORS with generators_free, also
// after a failure. There must be a grain.
enum status place_generators(const struct packing *packing, double reach, bool power,
                             struct generators *generators, struct reason *reason);
void generators_free(struct generators *generators);

// STATUS_BAD_DATA if two grains have the same centre, also across a side that repeats:
// only one of them would get a cell. O(n log n).
enum status check_distinct(const struct generators *generators, struct reason *reason);

// POSITION in another image of the box, in units; exact on the grid.
struct vector position_in_image(const struct generators *generators,
                                struct vector position, struct image image);

// Whether there are copies.
static inline bool has_copies(const struct generators *generators)
{
    return generators->n > generators->n_base;
}

// Whether generator I is a grain, not an image of one.
static inline bool is_grain(const struct generators *generators, int32_t i)
{
    return generators->origin[i].base < generators->n_particle &&
           (!has_copies(generators) ||
            same_image(generators->origin[i].image, (struct image){0}));
}

// Orders generators by their bases, then by their images. Copies of two generators,
// moved alike, compare alike.
static inline int compare_generators(const struct generators *generators, int32_t a,
                                     int32_t b)
{
    const int32_t first = generators->origin[a].base,
                  second = generators->origin[b].base;
    if (first != second) return first < second ? -1 : 1;
    if (!has_copies(generators)) return 0;
    return image_number(generators->origin[a].image) -
           image_number(generators->origin[b].image);
}
