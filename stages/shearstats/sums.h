// SPDX-License-Identifier: GPL-3.0-or-later
// What is summed over grains and contacts in each cell. A sum is additive over
// snapshots, blocks and threads, fields are not: so sums are kept and fields are made
// late (fields.c).
#pragma once

#include "frame.h"
#include "grid.h"
#include "motion.h"

// Columns. Vectors and tensors have the local components; symmetric tensors in the
// order 00, 11, 22, 01, 02, 12. m mass, v velocity, r distance from the axis of a
// cylinder. SI: kg, m3, kg m/s, J, kg m2, kg m2/s, N m, N.
enum sum {
    SUM_MASS = 0,     // m
    SUM_VOLUME = 1,   // of the grains
    SUM_COUNT = 2,    // grains
    SUM_MOMENTUM = 3, // m v
    SUM_FLUX = 6,     // m v v, symmetric
    SUM_INERTIA = 12, // m r^2
    SUM_TURNING = 13, // m r v
    SUM_TOUCHING = 16,
    SUM_JOINED = 17,   // bridges of the grains
    GRAIN_SUMS = 18,   // columns from 0 that come from grains
    SUM_CONTACT = 18,  // force times branch, 9: row force, column branch
    SUM_BRIDGE = 27,   // the same of bridges
    SUM_FABRIC = 36,   // n n of those that touch, symmetric
    SUM_CONTACTS = 42, // those that touch
    CONTACT_SUMS = 25, // columns from SUM_CONTACT that come from contacts
    SUM_TRACTION = 43, // force of walls and driven grains, at the contact
    SUM_ALL = 46
};

// Adds snapshot S of MOTION to SUM (n_cell, SUM_ALL). Driven grains and walls are the
// boundary: they have no mass here, and a contact with them reaches from the grain's
// centre to the contact. Other snapshots add to the same SUM, which begins as zeros.
// Threads need a SUM each.
void add_snapshot(const struct motion *motion, int s, const struct frame *frame,
                  const struct grid *grid, double *sum);

// The branch of contact K of snapshot S, of which POINT is one end and the other is
// further by the result; false where neither end is a grain that moves freely. S must
// be in the window. In m; the nearest image in a box that repeats.
bool branch_of(const struct motion *motion, int s, int64_t k, struct vector *from,
               struct vector *along);

// Unit vector from the first grain of contact K to what it touches. Of a wall: to the
// contact point. 0 if both lie in one place.
struct vector contact_normal(const struct motion *motion, int s, int64_t k);
