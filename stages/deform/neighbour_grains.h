// SPDX-License-Identifier: GPL-3.0-or-later
// The grains around each node of a network, from the faces that meet there.
#ifndef CRAQUELURE_NEIGHBOUR_GRAINS_H
#define CRAQUELURE_NEIGHBOUR_GRAINS_H

#include "network/network.h"

// A grain, and its periodic image as seen from a node in the box.
struct grain_beside {
    int32_t grain;
    struct image image;
};

struct neighbour_grains {
    int64_t *offset;         // (n_node+1)
    struct grain_beside *at; // grains around node i from offset[i] on, each once
    uint8_t *walls;          // (n_node) walls of the box among its faces, as bits
};

// O(n_face_node). The caller frees it with neighbour_grains_free.
struct neighbour_grains find_neighbour_grains(const struct network *network);
void neighbour_grains_free(struct neighbour_grains *around);

// The vector from FROM to the grain, m.
struct vector to_grain(const struct packing *packing, struct grain_beside beside,
                       struct vector from);

// Whether both are the same grain in the same image: not two images of one.
bool same_grain(struct grain_beside a, struct grain_beside b);

#endif
