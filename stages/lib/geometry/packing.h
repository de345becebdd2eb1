// SPDX-License-Identifier: GPL-3.0-or-later
// A packing of spherical grains in a box, with the bonds between them: what packing.h5
// holds, in memory. Coordinates are those of the artifact: m, from any origin. Grains
// may stick out of the box.
//
// How places are read where the box repeats: a grain is listed once, and any of its
// images is as good. From one thing to another goes image_apart or nearest_image
// (neighbours.h), never a difference of positions. Where it does not repeat along an
// axis, wall 2 axis and 2 axis + 1 stand there, unless a body takes their place.
#pragma once

#include "geometry/domain_shape.h"
#include "geometry/image.h"
#include "geometry/vector.h"

#include <stdbool.h>
#include <stdint.h>

// The six walls of the box, as bits (a node may lie on up to three) and in this order
// wherever walls are numbered: wall k, 0 to 5, is bit 1 << k, across axis k / 2, upper
// where k is odd.
enum wall {
    WALL_X_LOWER = 1,
    WALL_X_UPPER = 2,
    WALL_Y_LOWER = 4,
    WALL_Y_UPPER = 8,
    WALL_Z_LOWER = 16,
    WALL_Z_UPPER = 32
};
enum { WALL_COUNT = 6 };

// Two more that need not be flat, numbered after those: around the grains, and around
// what they lie around.
enum { WALL_OUTER = 6, WALL_INNER = 7, MOST_BODIES = 3 };

enum grain_kind {
    GRAIN_SOLID = 0,
    GRAIN_AUXILIARY = 1 // not there: only gives the boundary layer its nodes [K 3.3.5]
};

// It owns its arrays. Their rows are those of /particles and /bonds. packing_free frees
// it, also one that was filled in part. A copy of the struct shares the arrays: only
// one of them may be freed.
struct packing {
    int n_particle;
    struct vector *position; // (n_particle) m
    double *radius;          // (n_particle) m
    uint8_t *kind;           // (n_particle) enum grain_kind; NULL: all are solid
    struct vector lower;     // domain box, m
    struct vector upper;
    uint8_t periodic[3]; // 1 where the box repeats along x, y, z
    int n_body;
    struct body body[MOST_BODIES]; // what bounds the grains besides the box
    int n_bond;
    int32_t (*bond)[2];    // (n_bond) the two bonded grains, lower index first
    double *bond_strength; // (n_bond) over the mean one; NULL: all have the mean
};

// Whether the box repeats along any direction.
bool is_periodic(const struct packing *packing);

// Whether GRAIN is of kind GRAIN_AUXILIARY: it bounds cells but is not solid.
bool is_auxiliary(const struct packing *packing, int grain);

// Where wall 0..5 of the box stands along its axis, wall / 2; m.
double wall_position(const struct packing *packing, int wall);

// The wall, WALL_OUTER or WALL_INNER, that the surface of BODY is.
static inline int body_wall(const struct body *body)
{
    return body->within ? WALL_OUTER : WALL_INNER;
}

// The point nearest to X on wall 0..5, WALL_OUTER or WALL_INNER (the nearest body's; X
// itself where there is no such body). m. Of the flat walls: X with one coordinate
// changed, also where that point is beyond the edges of the box. O(n_body).
struct vector nearest_on_wall(const struct packing *packing, int wall, struct vector x);

// Body K in the repetition of the box nearest to X, going on beyond the sides of the
// box that it reaches (to 1e-9 of the edge): there it has no flat end. Always ask this
// one, not packing->body, where a place has to do with a body.
struct body body_near(const struct packing *packing, int k, struct vector x);

// Whether the grains lie in a body that is round across AXIS, 0 to 2: it takes the
// place of the flat walls of the box there.
bool packing_is_round_across(const struct packing *packing, int axis);

// How far X is from the surfaces of the bodies, inwards, m; below 0 beyond one of them.
// HUGE_VAL without bodies. O(n_body).
double depth_in_bodies(const struct packing *packing, struct vector x);

// From something in the box to what it repeats IMAGE boxes away; m. Each component is a
// whole number of edges.
struct vector image_offset(const struct packing *packing, struct image image);

// From FROM to what TO repeats IMAGE boxes away; exactly opposite when seen from there.
struct vector image_apart(const struct packing *packing, struct vector from,
                          struct vector to, struct image image);

// Volume of the box, or of the body within it, without what is cut out, m3.
double packing_domain_volume(const struct packing *packing);

// Its horizontal area, the mean over the height of the box, m2.
double packing_base_area(const struct packing *packing);

// The strengths of the bonds (n_bond), which the caller frees; NULL if it has none.
double *copy_bond_strengths(const struct packing *packing);

// MEAN times what each bond has of it (n_bond), which the caller frees; NULL where all
// have MEAN, also if that is INFINITY.
double *scale_bond_strengths(const struct packing *packing, double mean);

// Frees what the packing owns and empties it; safe on an empty one.
void packing_free(struct packing *packing);
