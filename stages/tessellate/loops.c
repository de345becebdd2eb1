// SPDX-License-Identifier: GPL-3.0-or-later
#include "loops.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

// Throats as seen from the faces beside them.
struct edges {
    struct row *row;   // the two nodes, the image of the second; which of those below
    double *clearance; // to the grains of the face, m
    int count, capacity, clearance_capacity;
};

void loops_append(struct loops *loops, const int32_t side[2], struct image image,
                  const struct corner *corner, int count)
{
    if (count < 3) return;
    GROW_ARRAY(loops->row, loops->count, loops->capacity);
    if (!loops->begin) GROW_ARRAY(loops->begin, 0, loops->begin_capacity);
    GROW_ARRAY(loops->begin, loops->count + 1, loops->begin_capacity);
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

static struct vector place(const struct network *network, struct vector at,
                           struct image image)
{
    return add(at, image_offset(&network->packing, image));
}

static void append_edge(struct edges *edges, struct corner a, struct corner b,
                        double clearance)
{
    const struct corner first = a.node < b.node ? a : b;
    const struct corner second = a.node < b.node ? b : a;
    const struct image apart = image_difference(second.image, first.image);
    GROW_ARRAY(edges->row, edges->count, edges->capacity);
    GROW_ARRAY(edges->clearance, edges->count, edges->clearance_capacity);
    edges->row[edges->count] = (struct row){
        .key = {first.node, second.node, image_number(apart)}, .item = edges->count};
    edges->clearance[edges->count++] = clearance;
}

static void append_edges(const struct network *network, const struct loops *loops,
                         const struct row *face, enum clearance how,
                         struct edges *edges)
{
    const struct packing *packing = &network->packing;
    const int64_t begin = loops->begin[face->item], end = loops->begin[face->item + 1];
    for (int64_t k = begin; k < end; k++) {
        const struct corner a = loops->corner[k];
        const struct corner b = loops->corner[k + 1 < end ? k + 1 : begin];
        const struct vector ends[2] = {
            place(network, network->node_position[a.node], a.image),
            place(network, network->node_position[b.node], b.image)};
        double least = HUGE_VAL;
        for (int side = 0; side < 2; side++) {
            const int32_t grain = face->key[side];
            const struct image image = numbered_image(side ? face->key[2] : 0);
            if (grain < 0) continue;
            least = fmin(least,
                         clearance_of(place(network, packing->position[grain], image),
                                      packing->radius[grain], ends, how));
        }
        append_edge(edges, a, b, least);
    }
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

// Of each edge the least clearance that the faces beside it say; keeps it at the index
// of the row.
static void fuse(struct edges *edges)
{
    struct row *row = edges->row;
    int kept = 0;
    for (int k = 0; k < edges->count; k++) {
        struct row *last = kept ? &row[kept - 1] : NULL;
        if (!last || memcmp(last->key, row[k].key, sizeof last->key))
            row[kept++] = row[k];
        else if (edges->clearance[row[k].item] < edges->clearance[last->item])
            last->item = row[k].item;
    }
    edges->count = kept;
}

static void store_throats(const struct edges *edges, struct network *network)
{
    const bool periodic = is_periodic(&network->packing);
    const int n = network->n_throat = edges->count;
    network->throat_nodes = allocate((size_t)n, sizeof *network->throat_nodes);
    network->throat_radius = NEW_ARRAY(double, n);
    network->throat_length = NEW_ARRAY(double, n);
    network->throat_kind = NEW_ARRAY(uint8_t, n);
    if (periodic) network->throat_image = NEW_ARRAY(struct image, n);
    for (int t = 0; t < n; t++) {
        const struct row *row = &edges->row[t];
        const int32_t a = row->key[0], b = row->key[1];
        const struct image image = numbered_image(row->key[2]);
        network->throat_nodes[t][0] = a;
        network->throat_nodes[t][1] = b;
        network->throat_radius[t] = fmax(0, edges->clearance[row->item]);
        network->throat_length[t] =
            distance(network->node_position[a],
                     place(network, network->node_position[b], image));
        if (periodic) network->throat_image[t] = image;
    }
}

// Numbers the nodes anew, those that are corners only.
static void keep_used_nodes(struct loops *loops, struct network *network)
{
    int *number = NEW_ARRAY(int, network->n_node);
    for (int64_t k = 0; k < loops->n_corner; k++)
        number[loops->corner[k].node] = 1;
    int n = 0;
    for (int i = 0; i < network->n_node; i++) {
        if (!number[i]) continue;
        network->node_position[n] = network->node_position[i];
        network->node_walls[n] = network->node_walls[i];
        number[i] = n++;
    }
    network->n_node = n;
    for (int64_t k = 0; k < loops->n_corner; k++)
        loops->corner[k].node = number[loops->corner[k].node];
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

void loops_to_network(struct loops *loops, enum clearance clearance,
                      struct network *network)
{
    struct edges edges = {0};
    keep_used_nodes(loops, network);
    loops->row = sort_rows(loops->row, loops->count);
    for (int f = 0; f < loops->count; f++)
        append_edges(network, loops, &loops->row[f], clearance, &edges);
    edges.row = sort_rows(edges.row, edges.count);
    fuse(&edges);
    forget(network);
    store_faces(loops, network);
    store_throats(&edges, network);
    free(edges.row);
    free(edges.clearance);
    free(loops->row);
    free(loops->begin);
    free(loops->corner);
    *loops = (struct loops){0};
}
