// SPDX-License-Identifier: GPL-3.0-or-later
// The grains around each node of a network, from the faces that meet there: four in a
// diagram in general position, more on lattices and where nodes were merged, fewer on
// walls. A node without a face has none.
#pragma once

#include "network/network.h"

// A grain, and its periodic image as seen from a node in the box.
struct grain_beside {
    int32_t grain;
    struct image image;
};

struct neighbour_grains {
    int64_t *offset;         // (n_node+1)
    struct grain_beside *at; // grains around node i from offset[i] on, each once
    uint8_t *walls;          // (n_node) walls among its faces, as bits of enum wall and
                             // of WALL_OUTER, WALL_INNER; of a layer also node_walls
};

// O(n_face_node). Grains of a node come in the order of their numbers and images. The
// caller frees it with neighbour_grains_free; NETWORK is not needed any more.
struct neighbour_grains find_neighbour_grains(const struct network *network);
void neighbour_grains_free(struct neighbour_grains *around);

// The vector from FROM, the place of the node that BESIDE is of, to the grain; m.
// PACKING may be another than that of the network, with the same grains moved.
struct vector to_grain(const struct packing *packing, struct grain_beside beside,
                       struct vector from);

// Whether both are the same grain in the same image: not two images of one.
bool same_grain(struct grain_beside a, struct grain_beside b);
