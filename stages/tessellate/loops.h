// SPDX-License-Identifier: GPL-3.0-or-later
// A network rebuilt from the loops of its faces.
#pragma once

#include "network/network.h"
#include "sort_rows.h"

// A node, in the image of the box in which the first grain of the face sees it.
struct corner {
    int32_t node;
    struct image image;
};

// Faces, one after the other, and throats, as often as they are met.
struct loops {
    struct row *row; // keys: the two sides, the image of the second; which loop
    int64_t *begin;  // where its corners begin; one more for the end
    int count, capacity, begin_capacity;
    struct corner *corner;
    int64_t n_corner, corner_capacity;

    struct row *throat; // keys: the two nodes, the image of the second; which of those
    double (*size)[2];  // its radius and length, m
    int n_throat, throat_capacity, size_capacity;
};

// Adds a face between SIDE[0] and SIDE[1] in repetition IMAGE, its COUNT corners
// counter-clockwise as seen from the second; one of fewer than three is none.
void loops_append(struct loops *loops, const int32_t side[2], struct image image,
                  const struct corner *corner, int count);

// Adds a throat, RADIUS and LENGTH in m. If it is added more than once, the least
// radius counts.
void loops_add_throat(struct loops *loops, struct corner a, struct corner b,
                      double radius, double length);

// Replaces the faces of NETWORK by these, in the order of their sides, and its throats
// by those that join corners of them; removes nodes that are no corner. All throats get
// the kind THROAT_NETWORK. Empties LOOPS.
void loops_to_network(struct loops *loops, struct network *network);
