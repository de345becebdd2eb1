// SPDX-License-Identifier: GPL-3.0-or-later
// A network rebuilt from the loops of its faces.
#ifndef CRAQUELURE_LOOPS_H
#define CRAQUELURE_LOOPS_H

#include "diagram.h"
#include "rows.h"

// A node, in the repetition of the box that the first grain of the face sees it in.
struct corner {
    int32_t node;
    struct image image;
};

// Faces one after the other.
struct loops {
    struct row *row; // keys: the two sides, the image of the second; which loop
    int64_t *begin;  // where its corners begin; one more for the end
    int count, capacity, begin_capacity;
    struct corner *corner;
    int64_t n_corner, corner_capacity;
};

// Adds a face between SIDE[0] and SIDE[1] in repetition IMAGE, its COUNT corners
// counter-clockwise as seen from the second; one of fewer than three is none.
void loops_append(struct loops *loops, const int32_t side[2], struct image image,
                  const struct corner *corner, int count);

// Gives the network these faces, in the order of their sides; as throats the edges of
// them; and takes away nodes that are in none. All throats are of kind network. Empties
// LOOPS.
void loops_to_network(struct loops *loops, enum clearance clearance,
                      struct network *network);

#endif
