// SPDX-License-Identifier: GPL-3.0-or-later
// Each corner of a face is the start of one throat, which leads to the next corner of
// the loop. A counting sort by throat, in the order of the faces, gives compressed
// rows:
//     find_throats   throat[k] of every corner k, by face_throat (the costly part,
//                    shared among threads: each writes to places of its own);
//     counting       offset[t + 2] = sides of throat t, then summed to where t begins;
//     filling        each side goes to the place offset[t + 1], which moves on by one,
// so that in the end the sides of t are offset[t] .. offset[t + 1] - 1, rising faces.
// Neither the rows nor the face that is refused, the first without a throat, depend on
// the number of threads. O(corners x throats at a node).
//
// throat_side tells which way the loop of the face leads along the throat: by the two
// nodes, and of a throat from a node to its own image by the images of the corners.
#include "network/throat_sides.h"

#include "basics/memory.h"

#include <stdlib.h>

// The throat of each corner of each face; the first face that lacks one, or n_face.
static int find_throats(const struct network *network, int32_t *throat)
{
    struct incidence incidence = network_incidence(network);
    int missing = network->n_face;
#pragma omp parallel for schedule(static) reduction(min : missing)
    for (int face = 0; face < network->n_face; face++) {
        const int64_t begin = network->face_offset[face];
        const int count = (int)(network->face_offset[face + 1] - begin);
        for (int k = 0; k < count; k++) {
            throat[begin + k] = face_throat(network, &incidence, face, k);
            if (throat[begin + k] < 0 && face < missing) missing = face;
        }
    }
    incidence_free(&incidence);
    return missing;
}

// Names the two nodes of the first gap in the loop of FACE, which has one.
static enum status refuse_face(const struct network *network, const int32_t *throat,
                               int face, struct reason *reason)
{
    const int64_t begin = network->face_offset[face],
                  end = network->face_offset[face + 1];
    int64_t k = begin;
    while (throat[k] >= 0)
        k++;
    return refuse(reason, STATUS_BAD_DATA,
                  "/faces/nodes: face %d: no throat between nodes %d and %d", face,
                  network->face_nodes[k],
                  network->face_nodes[k + 1 < end ? k + 1 : begin]);
}

enum status throat_sides_init(const struct network *network, struct throat_sides *sides,
                              struct reason *reason)
{
    const int64_t count = network->n_face ? network->face_offset[network->n_face] : 0;
    *sides = (struct throat_sides){0};
    int32_t *throat = NEW_ARRAY(int32_t, count);
    const int missing = find_throats(network, throat);
    if (missing < network->n_face) {
        const enum status status = refuse_face(network, throat, missing, reason);
        free(throat);
        return status;
    }
    int64_t *offset = NEW_ARRAY(int64_t, network->n_throat + 2);
    for (int64_t k = 0; k < count; k++)
        offset[throat[k] + 2]++;
    for (int t = 0; t < network->n_throat; t++) {
        if (offset[t + 2] > sides->most) sides->most = (int)offset[t + 2];
        offset[t + 2] += offset[t + 1];
    }
    sides->face = NEW_ARRAY(int32_t, count);
    sides->corner = NEW_ARRAY(int32_t, count);
    for (int face = 0; face < network->n_face; face++) // moves offset[t + 1] to its end
        for (int64_t k = network->face_offset[face]; k < network->face_offset[face + 1];
             k++) {
            const int64_t to = offset[throat[k] + 1]++;
            sides->face[to] = face;
            sides->corner[to] = (int32_t)(k - network->face_offset[face]);
        }
    sides->offset = offset;
    free(throat);
    return STATUS_OK;
}

void throat_sides_free(struct throat_sides *sides)
{
    free(sides->offset);
    free(sides->face);
    free(sides->corner);
    *sides = (struct throat_sides){0};
}

// Positions are those of the corners, not of the nodes: in a box that repeats, the ends
// of the throat must be in the same repetition as the grains of the face.
struct throat_side throat_side(const struct network *network,
                               const struct throat_sides *sides, int throat, int64_t k)
{
    const int64_t begin = network->face_offset[sides->face[k]],
                  end = network->face_offset[sides->face[k] + 1];
    const int64_t from = begin + sides->corner[k],
                  to = from + 1 < end ? from + 1 : begin;
    const int32_t *ends = network->throat_nodes[throat];
    bool forward =
        network->face_nodes[from] == ends[0] && network->face_nodes[to] == ends[1];
    if (forward && network->throat_image) {
        const struct image apart = image_difference(network->face_node_image[to],
                                                    network->face_node_image[from]);
        forward = same_image(apart, network->throat_image[throat]);
    }
    const struct vector a = face_corner(network, from), b = face_corner(network, to);
    return forward ? (struct throat_side){a, b, true}
                   : (struct throat_side){b, a, false};
}
