// SPDX-License-Identifier: GPL-3.0-or-later
// Faces: what separates two grains, or a grain from a wall, dual to the edges of the
// triangulation.
#include "assemble.h"

#include "basics/memory.h"
#include "rows.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_AROUND = 1 << 20 }; // cells around one edge; more means broken links

// The corners of a face, each a node and the repetition of the box it is in.
struct loop {
    int32_t *node;
    struct image *image;
    int count, capacity;
    bool forward; // counter-clockwise seen from the second side
};

// Faces in the order in which they are met.
struct face_list {
    struct row *row; // the two sides, the image of the second; which face
    int64_t *offset; // where its corners begin
    int count, capacity;
    int32_t *node;
    struct image *image;
    int64_t n_node, node_capacity;
};

// Which of the six edges of a cell joins two of its corners, as a bit.
static const uint8_t edge_bit[4][4] = {
    {0, 1, 2, 4}, {1, 0, 8, 16}, {2, 8, 0, 32}, {4, 16, 32, 0}};

static void append_corner(struct loop *loop, int32_t node, struct image image)
{
    const int last = loop->count - 1;
    if (loop->count && loop->node[last] == node && same_image(loop->image[last], image))
        return;
    if (loop->count == loop->capacity) {
        loop->capacity = loop->capacity ? 2 * loop->capacity : 64;
        loop->node = reallocate(loop->node, (size_t)loop->capacity, sizeof node);
        loop->image = reallocate(loop->image, (size_t)loop->capacity, sizeof image);
    }
    loop->node[loop->count] = node;
    loop->image[loop->count++] = image;
}

static bool is_even(int a, int b, int c, int d)
{
    return ((a > b) + (a > c) + (a > d) + (b > c) + (b > d) + (c > d)) % 2 == 0;
}

// Turns around the edge P-Q of cell START, gathers the nodes passed, and marks the edge
// as seen in every cell passed: in positively oriented cells it turns forward when the
// corners in the order P, Q, that left opposite of, that stays are an even permutation.
// False when the way leaves the finite cells.
static bool turn_around(const struct assembly *assembly, int start, int32_t p,
                        int32_t q, struct loop *loop)
{
    const struct triangulation *cells = assembly->triangulation;
    int32_t leaving = -1; // the corner that the next step goes opposite of
    int cell = start, steps = 0;
    loop->count = 0;
    do {
        struct cell *here = &cells->cell[cell];
        const int32_t *corner = here->vertex;
        int at_p = 0, at_q = 0, through = -1, stays = -1;
        for (int k = 0; k < 4; k++) {
            if (corner[k] == p)
                at_p = k;
            else if (corner[k] == q)
                at_q = k;
            else if (through < 0 && (leaving < 0 || corner[k] == leaving))
                through = k;
            else
                stays = k;
        }
        here->seen |= edge_bit[at_p][at_q];
        if (!steps) loop->forward = is_even(at_p, at_q, through, stays);
        append_corner(loop, here->node, here->image);
        // The next way out is opposite the corner that stays.
        leaving = corner[stays];
        cell = here->neighbour[through];
        if (cell < 0 || ++steps > MOST_AROUND) return false;
    } while (cell != start);
    while (loop->count > 1 && loop->node[loop->count - 1] == loop->node[0] &&
           same_image(loop->image[loop->count - 1], loop->image[0]))
        loop->count--;
    return true;
}

// Whose face it is: a grain and a grain, or a grain and the wall it is reflected in. Of
// many copies the one counts whose first side is a grain itself: P comes first.
static bool is_face(const struct generators *generators, int32_t p, int32_t q,
                    struct row *row)
{
    if (p >= generators->n_particle) return false;
    const int wall = generators->wall[q];
    row->key[0] = p;
    row->key[1] = wall < 0 ? generators->particle[q] : -1 - wall;
    row->key[2] = image_number(generators->image[q]);
    return wall < 0 || (generators->particle[q] == p && !row->key[2]);
}

static bool comes_first(const struct loop *loop, int a, int b)
{
    if (loop->node[a] != loop->node[b]) return loop->node[a] < loop->node[b];
    return image_number(loop->image[a]) < image_number(loop->image[b]);
}

// A loop begins with its lowest node, and its normal points from the first side of the
// face to the second, also where the first lies beyond its own face.
static void append_face(struct face_list *faces, const struct row *row,
                        const struct loop *loop)
{
    if (faces->count == faces->capacity) {
        faces->capacity = faces->capacity ? 2 * faces->capacity : 1024;
        faces->row = reallocate(faces->row, (size_t)faces->capacity, sizeof *row);
        faces->offset =
            reallocate(faces->offset, (size_t)faces->capacity + 1, sizeof(int64_t));
    }
    if (faces->n_node + loop->count > faces->node_capacity) {
        faces->node_capacity = 2 * (faces->n_node + loop->count) + 1024;
        const size_t capacity = (size_t)faces->node_capacity;
        faces->node = reallocate(faces->node, capacity, sizeof *faces->node);
        faces->image = reallocate(faces->image, capacity, sizeof *faces->image);
    }
    int first = 0;
    for (int k = 1; k < loop->count; k++)
        if (comes_first(loop, k, first)) first = k;
    for (int k = 0; k < loop->count; k++) {
        const int from = first + (loop->forward ? k : loop->count - k);
        faces->node[faces->n_node + k] = loop->node[from % loop->count];
        faces->image[faces->n_node + k] = loop->image[from % loop->count];
    }
    faces->row[faces->count] = *row;
    faces->row[faces->count].item = faces->count;
    faces->offset[faces->count++] = faces->n_node;
    faces->n_node += loop->count;
    faces->offset[faces->count] = faces->n_node;
}

// Into the network, by the grains they separate.
static void store(const struct face_list *faces, struct network *network)
{
    network->n_face = faces->count;
    network->face_offset = NEW_ARRAY(int64_t, faces->count + 1);
    network->face_nodes = NEW_ARRAY(int32_t, faces->n_node);
    network->face_particles =
        allocate((size_t)faces->count, sizeof *network->face_particles);
    const bool periodic = is_periodic(&network->packing);
    if (periodic) {
        network->face_image = NEW_ARRAY(struct image, faces->count);
        network->face_node_image = NEW_ARRAY(struct image, faces->n_node);
    }
    for (int f = 0; f < faces->count; f++) {
        const struct row *row = &faces->row[f];
        const int64_t from = faces->offset[row->item], to = network->face_offset[f];
        const size_t size = (size_t)(faces->offset[row->item + 1] - from);
        network->face_offset[f + 1] = to + (int64_t)size;
        memcpy(network->face_nodes + to, faces->node + from, size * sizeof(int32_t));
        network->face_particles[f][0] = row->key[0];
        network->face_particles[f][1] = row->key[1];
        if (!periodic) continue;
        network->face_image[f] = numbered_image(row->key[2]);
        memcpy(network->face_node_image + to, faces->image + from,
               size * sizeof(struct image));
    }
}

// Those around the edges of one cell that were not seen from another.
static void find_faces(const struct assembly *assembly, int cell, struct loop *loop,
                       struct face_list *faces)
{
    static const int edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    const struct generators *generators = assembly->generators;
    const int32_t *corner = assembly->triangulation->cell[cell].vertex;
    for (int e = 0; e < 6; e++) {
        if (assembly->triangulation->cell[cell].seen &
            edge_bit[edges[e][0]][edges[e][1]])
            continue;
        int32_t p = corner[edges[e][0]], q = corner[edges[e][1]];
        if (compare_generators(generators, p, q) > 0) {
            p = corner[edges[e][1]];
            q = corner[edges[e][0]];
        }
        struct row row = {0};
        if (!is_face(generators, p, q, &row)) continue;
        if (!turn_around(assembly, cell, p, q, loop)) continue;
        if (loop->count < 3) continue; // closed up on a wall
        append_face(faces, &row, loop);
    }
}

void assemble_faces(const struct assembly *assembly, struct network *network)
{
    struct face_list faces = {0};
    struct loop loop = {0};
    for (int c = 0; c < assembly->triangulation->n_cell; c++)
        if (assembly->triangulation->cell[c].node >= 0)
            find_faces(assembly, c, &loop, &faces);
    faces.row = sort_rows(faces.row, faces.count);
    store(&faces, network);
    free(loop.node);
    free(loop.image);
    free(faces.row);
    free(faces.offset);
    free(faces.node);
    free(faces.image);
}
