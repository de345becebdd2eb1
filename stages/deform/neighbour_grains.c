// SPDX-License-Identifier: GPL-3.0-or-later
// Both sides of every face are grains around the nodes of its loop. In a periodic box
// corners and the second side have images as seen from the first side; from the node at
// a corner
//     image of the first side  = 0      - image of the corner,
//     image of the second side = its own - image of the corner.
// Each grain is met once for every face of it at the node: rows are filled with all of
// them, two a corner at most, then sorted by grain and image and each kept once. What
// is kept moves together in place, towards the beginning. O(corners) while nodes have a
// few faces.
//
// A side below 0 is a wall and gives the node its bit. So these bits are of walls that
// the node lies on, where node_walls may have those that it only faces
// (tessellate/surface_marks.c); in a layer, whose faces are its cells, there is nothing
// but node_walls.
#include "neighbour_grains.h"

#include "basics/memory.h"

#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    const struct grain_beside *p = a, *q = b;
    if (p->grain != q->grain) return p->grain < q->grain ? -1 : 1;
    return image_number(p->image) - image_number(q->image);
}

bool same_grain(struct grain_beside a, struct grain_beside b)
{
    return a.grain == b.grain && same_image(a.image, b.image);
}

struct vector to_grain(const struct packing *packing, struct grain_beside beside,
                       struct vector from)
{
    return image_apart(packing, from, packing->position[beside.grain], beside.image);
}

// Both sides of the face at CORNER of its loop, as its node sees them.
static void add_sides(const struct network *network, int face, int64_t corner,
                      struct neighbour_grains *around, int64_t *end)
{
    const int node = network->face_nodes[corner];
    const int32_t *side = network->face_particles[face];
    const struct image none = {0};
    const struct image here =
        network->face_node_image ? network->face_node_image[corner] : none;
    const struct image second = network->face_image ? network->face_image[face] : none;
    around->at[end[node]++] = (struct grain_beside){side[0], image_opposite(here)};
    if (side[1] >= 0)
        around->at[end[node]++] =
            (struct grain_beside){side[1], image_difference(second, here)};
    else
        around->walls[node] |= (uint8_t)(1u << (-1 - side[1]));
}

// Sorts the grains around each node, and keeps each once.
static void keep_once(int n_node, const int64_t *end, struct neighbour_grains *around)
{
    int64_t kept = 0;
    for (int i = 0; i < n_node; i++) {
        const int64_t begin = around->offset[i], count = end[i] - begin;
        qsort(around->at + begin, (size_t)count, sizeof *around->at, compare);
        around->offset[i] = kept;
        for (int64_t k = begin; k < end[i]; k++)
            if (kept == around->offset[i] ||
                !same_grain(around->at[kept - 1], around->at[k]))
                around->at[kept++] = around->at[k];
    }
    around->offset[n_node] = kept;
}

struct neighbour_grains find_neighbour_grains(const struct network *network)
{
    const int n = network->n_node;
    const int64_t n_corner = network->face_offset[network->n_face];
    struct neighbour_grains around = {.offset = NEW_ARRAY(int64_t, n + 1),
                                      .at =
                                          NEW_ARRAY(struct grain_beside, 2 * n_corner),
                                      .walls = NEW_ARRAY(uint8_t, n)};
    for (int64_t k = 0; k < n_corner; k++)
        around.offset[network->face_nodes[k] + 1] += 2;
    for (int i = 0; i < n; i++)
        around.offset[i + 1] += around.offset[i];
    int64_t *end = duplicate(around.offset, (size_t)n + 1, sizeof *end);
    for (int f = 0; f < network->n_face; f++)
        for (int64_t k = network->face_offset[f]; k < network->face_offset[f + 1]; k++)
            add_sides(network, f, k, &around, end);
    keep_once(n, end, &around);
    // The cells of a layer are its faces, none of which lies in a wall beside it.
    const bool layer = is_layer(network);
    for (int i = 0; i < n && layer; i++)
        around.walls[i] |= network->node_walls[i];
    free(end);
    return around;
}

void neighbour_grains_free(struct neighbour_grains *around)
{
    free(around->offset);
    free(around->at);
    free(around->walls);
    *around = (struct neighbour_grains){0};
}
