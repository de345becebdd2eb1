// SPDX-License-Identifier: GPL-3.0-or-later
// Where each throat lies beside each grain: the sectors from which all forms of the
// capillary force are made.
#pragma once

#include "basics/status.h"
#include "network/network.h"

// One throat beside one face of one grain's cell, seen from that grain: the triangle
// from the foot of the face to the throat. In a layer of grains the face is the throat
// itself, and the foot is its middle. All places are in one repetition of the box, the
// same for all wedges of one face.
struct sector {
    int32_t throat, grain;
    int32_t beyond;         // the grain across the face; below 0: a wall
    int32_t face;           // -1: of a face that the network has not kept
    struct vector centre;   // of the grain
    struct vector across;   // centre of the grain beyond, or the foot on the wall
    struct vector foot;     // where the line between the two crosses the face [K 3.2]
    struct vector from, to; // the throat, counter-clockwise seen from beyond
};

struct sectors {
    const struct network *network;
    struct network *spare; // the same, if its faces may go with the sides; or NULL
    bool layer;
    struct side *side;     // what is known of them, by throats
    int64_t *offset;       // (n_throat+1) into SIDE
    bool *open;            // (n_throat) a face beside it is missing
    uint8_t *surface;      // (n_throat) walls it lies in, bits of enum wall; below an
                           // auxiliary layer those it faces
    struct sector *sector; // of the throat asked for last
    int capacity;
};

// Finds all wedges of NETWORK, which must live as long. Where cut cells were left out
// (boundary=eliminate) a throat between one that stays and two that do not has lost
// the face between these two; its wedges are there all the same, so that all grains
// around a throat feel it, but for one between those two, as on lattices. In a layer
// the grain that lost its cell is that of least power at the throat.
//
// STATUS_BAD_DATA when two neighbours in a face's loop are not joined by a throat, or
// a cell is open elsewhere. The caller frees with sectors_free, also after a failure.
enum status sectors_find(const struct network *network, struct sectors *sectors,
                         struct reason *reason);
void sectors_free(struct sectors *sectors);
// Frees all but .surface early, and the faces of .spare: sectors_at must not be called
// again.
void sectors_free_sides(struct sectors *sectors);

// The wedges of THROAT in wedges->wedge, until asked again; returns how many.
int sectors_at(struct sectors *sectors, int throat);
