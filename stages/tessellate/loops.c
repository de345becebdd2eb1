// SPDX-License-Identifier: GPL-3.0-or-later
// Collects faces and throats in any order, sorts both, and writes them to the network:
// each face begins with its lowest node, equal throats become one with the least
// radius, and nodes that are no corner of a face are removed.
//
// A row is a key of three numbers and the item it belongs to: of a face its two sides
// and the image of the second, of a throat its lower node, its other node and the image
// of that. The lower node comes first, and the image is turned round with them; of the
// two images of a throat that joins a node to its own image, the one with the number
// above 0 is taken. So a throat has one key, from whichever face it comes.
#include "loops.h"

#include "basics/memory.h"
#include "remove_cells.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

void loops_append(struct loops *loops, const int32_t side[2], struct image image,
                  const struct corner *corner, int count)
{
    if (count < 3) return;
    GROW_ARRAY(loops->row, loops->count, loops->capacity);
    if (!loops->begin) GROW_ARRAY(loops->begin, 0, loops->begin_capacity);
    GROW_ARRAY(loops->begin, loops->count + 1, loops->begin_capacity);
    assert(loops->begin);
    int first = 0;
    for (int k = 1; k < count; k++)
        if (corner[k].node < corner[first].node) first = k;
    loops->begin[loops->count] = loops->n_corner;
    for (int k = 0; k < count; k++) {
        GROW_ARRAY(loops->corner, loops->n_corner, loops->corner_capacity);
        loops->corner[loops->n_corner++] = corner[(first + k) % count];
    }
    loops->row[loops->count] = (struct row){
        .key = {side[0], side[1], image_number(image)}, .item = loops->count};
    loops->begin[++loops->count] = loops->n_corner;
}

void loops_add_throat(struct loops *loops, struct corner a, struct corner b,
                      double radius, double length)
{
    const struct corner first = a.node < b.node ? a : b;
    const struct corner second = a.node < b.node ? b : a;
    struct image apart = image_difference(second.image, first.image);
    if (a.node == b.node && image_number(apart) < 0) apart = image_opposite(apart);
    const int k = loops->n_throat;
    GROW_ARRAY(loops->throat, k, loops->throat_capacity);
    GROW_ARRAY(loops->size, k, loops->size_capacity);
    loops->throat[k] =
        (struct row){.key = {first.node, second.node, image_number(apart)}, .item = k};
    loops->size[k][0] = radius;
    loops->size[k][1] = length;
    loops->n_throat++;
}

static void store_faces(const struct loops *loops, struct network *network)
{
    const bool periodic = is_periodic(&network->packing);
    network->n_face = loops->count;
    network->face_offset = NEW_ARRAY(int64_t, loops->count + 1);
    network->face_nodes = NEW_ARRAY(int32_t, loops->n_corner);
    network->face_particles =
        allocate((size_t)loops->count, sizeof *network->face_particles);
    if (periodic) {
        network->face_image = NEW_ARRAY(struct image, loops->count);
        network->face_node_image = NEW_ARRAY(struct image, loops->n_corner);
    }
    int64_t to = 0;
    for (int f = 0; f < loops->count; f++) {
        const struct row *row = &loops->row[f];
        network->face_particles[f][0] = row->key[0];
        network->face_particles[f][1] = row->key[1];
        if (periodic) network->face_image[f] = numbered_image(row->key[2]);
        for (int64_t k = loops->begin[row->item]; k < loops->begin[row->item + 1];
             k++, to++) {
            network->face_nodes[to] = loops->corner[k].node;
            if (periodic) network->face_node_image[to] = loops->corner[k].image;
        }
        network->face_offset[f + 1] = to;
    }
}

// Makes equal throats one; its row keeps the index of the smallest radius.
static void fuse_throats(struct loops *loops)
{
    struct row *row = loops->throat;
    int kept = 0;
    for (int k = 0; k < loops->n_throat; k++) {
        struct row *last = kept ? &row[kept - 1] : NULL;
        if (!last || memcmp(last->key, row[k].key, sizeof last->key))
            row[kept++] = row[k];
        else if (loops->size[row[k].item][0] < loops->size[last->item][0])
            last->item = row[k].item;
    }
    loops->n_throat = kept;
}

static void store_throats(const struct loops *loops, struct network *network)
{
    const bool periodic = is_periodic(&network->packing);
    const int n = network->n_throat = loops->n_throat;
    network->throat_nodes = allocate((size_t)n, sizeof *network->throat_nodes);
    network->throat_radius = NEW_ARRAY(double, n);
    network->throat_length = NEW_ARRAY(double, n);
    network->throat_kind = NEW_ARRAY(uint8_t, n);
    if (periodic) network->throat_image = NEW_ARRAY(struct image, n);
    for (int t = 0; t < n; t++) {
        const struct row *row = &loops->throat[t];
        network->throat_nodes[t][0] = row->key[0];
        network->throat_nodes[t][1] = row->key[1];
        network->throat_radius[t] = loops->size[row->item][0];
        network->throat_length[t] = loops->size[row->item][1];
        if (periodic) network->throat_image[t] = numbered_image(row->key[2]);
    }
}

// Removes nodes that are no corner. Returns the new number of each node, -1: removed.
static int *number_corners(const struct loops *loops, struct network *network)
{
    int *number = NEW_ARRAY(int, network->n_node);
    for (int i = 0; i < network->n_node; i++)
        number[i] = -1;
    for (int64_t k = 0; k < loops->n_corner; k++)
        number[loops->corner[k].node] = 0;
    compact_nodes(network, number);
    return number;
}

static void keep_corners(struct loops *loops, struct network *network)
{
    int *number = number_corners(loops, network);
    for (int64_t k = 0; k < loops->n_corner; k++)
        loops->corner[k].node = number[loops->corner[k].node];
    int kept = 0;
    for (int t = 0; t < loops->n_throat; t++) {
        struct row row = loops->throat[t];
        for (int end = 0; end < 2; end++)
            row.key[end] = number[row.key[end]];
        if (row.key[0] >= 0 && row.key[1] >= 0) loops->throat[kept++] = row;
    }
    loops->n_throat = kept;
    free(number);
}

static void forget(struct network *network)
{
    free(network->throat_nodes);
    free(network->throat_radius);
    free(network->throat_length);
    free(network->throat_kind);
    free(network->throat_image);
    free(network->face_offset);
    free(network->face_nodes);
    free(network->face_particles);
    free(network->face_image);
    free(network->face_node_image);
}

void loops_to_network(struct loops *loops, struct network *network)
{
    keep_corners(loops, network);
    loops->row = sort_rows(loops->row, loops->count);
    loops->throat = sort_rows(loops->throat, loops->n_throat);
    fuse_throats(loops);
    forget(network);
    store_faces(loops, network);
    store_throats(loops, network);
    free(loops->row);
    free(loops->begin);
    free(loops->corner);
    free(loops->throat);
    free(loops->size);
    *loops = (struct loops){0};
}
