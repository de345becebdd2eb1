// SPDX-License-Identifier: GPL-3.0-or-later
// The faces around each throat: every throat is a side of the faces that meet in it,
// three of them unless nodes were merged or a wall holds the throat.
#pragma once

#include "basics/status.h"
#include "network/network.h"

struct throat_sides {
    int64_t *offset; // (n_throat+1) those of throat t: offset[t] .. offset[t+1] - 1
    int32_t *face;   // the face, ascending within a throat
    int32_t *corner; // the corner of it, 0 and up, from which the throat leads
    int most;        // sides of one throat
};

// A side of a face as its throat sees it. Positions are in the repetition of the box in
// which the first grain of the face is.
struct throat_side {
    struct vector first, second; // m, the first and second node of the throat
    bool forward;                // the face's loop leads from first to second
};

// The sides of all throats; the caller frees them with throat_sides_free.
// STATUS_BAD_DATA: two neighbours in a face's loop are not joined by a throat. Threads
// share the work; the result is the same for any number.
enum status throat_sides_init(const struct network *network, struct throat_sides *sides,
                              struct reason *reason);
void throat_sides_free(struct throat_sides *sides);

// Side K of SIDES, which belongs to THROAT.
struct throat_side throat_side(const struct network *network,
                               const struct throat_sides *sides, int throat, int64_t k);
