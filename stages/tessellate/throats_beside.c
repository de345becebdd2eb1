// SPDX-License-Identifier: GPL-3.0-or-later
// Throats found by their two nodes, with a binary search: throats are sorted by their
// lower node, then by the other (loops.c). In a periodic box several throats may join
// the same two nodes through different images of the box; throat_image tells them
// apart. It is the image of the second node seen from the first, so an edge from the
// higher node to the lower is looked up the other way round, and a throat from a node
// to its own image is the same both ways.
#include "throats_beside.h"

#include "basics/memory.h"

#include <stdlib.h>

static int compare_ends(const int32_t *first, const int32_t *second)
{
    if (first[0] != second[0]) return first[0] < second[0] ? -1 : 1;
    return (first[1] > second[1]) - (first[1] < second[1]);
}

int first_throat_between(const struct network *network, const int32_t ends[2])
{
    int low = 0, high = network->n_throat;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (compare_ends(network->throat_nodes[middle], ends) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// Marks the throats between two corners of a face; of several between the same nodes
// only those that join the same images.
static void keep_throats(const struct network *network, int64_t from, int64_t to,
                         bool *stays)
{
    const int32_t a = network->face_nodes[from], b = network->face_nodes[to];
    const int32_t ends[2] = {a < b ? a : b, a < b ? b : a};
    const int64_t low = a < b ? from : to, high = a < b ? to : from;
    for (int t = first_throat_between(network, ends);
         t < network->n_throat && !compare_ends(network->throat_nodes[t], ends); t++) {
        if (!network->throat_image) {
            stays[t] = true;
            continue;
        }
        const struct image *image = network->face_node_image;
        const struct image apart = image_difference(image[high], image[low]);
        if (same_image(apart, network->throat_image[t]) ||
            (a == b && same_image(image_opposite(apart), network->throat_image[t])))
            stays[t] = true;
    }
}

bool *throats_beside(const struct network *network, const bool *grains)
{
    bool *beside = NEW_ARRAY(bool, network->n_throat);
    for (int f = 0; f < network->n_face; f++) {
        const int32_t *side = network->face_particles[f];
        if (!grains[side[0]] && (side[1] < 0 || !grains[side[1]])) continue;
        const int64_t begin = network->face_offset[f],
                      end = network->face_offset[f + 1];
        for (int64_t k = begin; k < end; k++)
            keep_throats(network, k, k + 1 < end ? k + 1 : begin, beside);
    }
    return beside;
}
