// SPDX-License-Identifier: GPL-3.0-or-later
// Faces: polygons between two grains, or a grain and a wall, dual to the edges of the
// triangulation. The corners of the face of edge (p, q) are the nodes of all cells
// around the edge, found by walking from cell to cell across the facets that contain
// it. Corners at one place are counted once; a face with fewer than three has closed up
// on a wall. Each face is found once: by the part of the cells that contains the first
// of those around its edge, and in a periodic box only for the copy whose first side is
// a grain itself.
#include "assemble.h"

#include "basics/memory.h"
#include "sort_rows.h"

#include <assert.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_AROUND = 1 << 20 }; // cells around one edge; more means broken links

// The corners of a face, each a node and the repetition of the box it is in.
struct loop {
    int32_t *node;
    struct image *image;
    int count, capacity;
    bool forward; // counter-clockwise seen from the second side
};

// A part of the cells, and the faces that are met first in it.
struct part {
    int begin, end;
};

struct face_list {
    struct row *row; // the two sides, the image of the second, which list, how many
                     // corners; where in the list those begin
    int count, capacity;
    int32_t *node;
    struct image *image; // NULL unless the box repeats
    int n_node, node_capacity;
};

// The bit of the edge of a cell that is opposite the edge between two of its corners.
static const uint8_t OPPOSITE_EDGE[4][4] = {
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

// Walks around the edge of cell START opposite the corners OUT and STAYS, first across
// the facet opposite OUT, gathers the nodes passed, and marks the edge as seen in the
// cells of the part. False when the walk leaves the finite cells, or meets a cell of an
// earlier part, to which the face then belongs.
static bool walk_around_edge(const struct triangulation *cells, struct part part,
                             int start, int out, int stays, struct loop *loop)
{
    int at = start, steps = 0;
    loop->count = 0;
    do {
        const struct cell *here = &cells->cell[at];
        assert(out != stays && 0 <= out && out < 4 && 0 <= stays && stays < 4);
        if (at < part.end) cells->seen[at] |= OPPOSITE_EDGE[out][stays];
        append_corner(loop, cells->node[at], node_image(cells, at));
        const int32_t next = here->neighbour[out], kept = here->vertex[stays];
        if (next < part.begin || ++steps > MAX_AROUND) return false;
        // The corner that stayed is left next; the new one stays.
        out = index_among(cells->cell[next].vertex, kept);
        stays = index_among(cells->cell[next].neighbour, at);
        at = next;
    } while (at != start);
    while (loop->count > 1 && loop->node[loop->count - 1] == loop->node[0] &&
           same_image(loop->image[loop->count - 1], loop->image[0]))
        loop->count--;
    return true;
}

// Whether the edge from P to Q is a face, and its sides: two grains, or a grain and the
// wall it is reflected in. Of many copies the one counts whose first side, P, is a
// grain itself.
static bool is_face(const struct generators *generators, int32_t p, int32_t q,
                    struct row *row)
{
    if (!is_grain(generators, p)) return false;
    const struct origin *first = &generators->origin[p],
                        *second = &generators->origin[q];
    row->key[0] = first->particle;
    row->key[1] = second->wall < 0 ? second->particle : -1 - second->wall;
    row->key[2] = image_number(second->image);
    return second->wall < 0 || (second->particle == first->particle && !row->key[2]);
}

static bool comes_first(const struct loop *loop, int a, int b)
{
    if (loop->node[a] != loop->node[b]) return loop->node[a] < loop->node[b];
    return image_number(loop->image[a]) < image_number(loop->image[b]);
}

static void reserve(struct face_list *faces, int more)
{
    GROW_ARRAY(faces->row, faces->count, faces->capacity);
    if (faces->n_node + more <= faces->node_capacity) return;
    faces->node_capacity = 2 * (faces->n_node + more) + 1024;
    const size_t capacity = (size_t)faces->node_capacity;
    faces->node = reallocate(faces->node, capacity, sizeof *faces->node);
    if (faces->image)
        faces->image = reallocate(faces->image, capacity, sizeof *faces->image);
}

// A loop begins with its lowest node, and its normal points from the first side of the
// face to the second, also where the first lies beyond its own face.
static void append_face(struct face_list *faces, const struct row *row,
                        const struct loop *loop)
{
    reserve(faces, loop->count);
    int first = 0;
    for (int k = 1; k < loop->count; k++)
        if (comes_first(loop, k, first)) first = k;
    for (int k = 0, from = first; k < loop->count; k++) {
        faces->node[faces->n_node + k] = loop->node[from];
        if (faces->image) faces->image[faces->n_node + k] = loop->image[from];
        from += loop->forward ? 1 : -1;
        if (from < 0) from = loop->count - 1;
        if (from == loop->count) from = 0;
    }
    struct row *added = &faces->row[faces->count++];
    *added = *row;
    added->key[4] = loop->count;
    added->item = faces->n_node;
    faces->n_node += loop->count;
}

// Finds the faces around the edges of one cell that no other cell has found.
static void find_faces(const struct assembly *assembly, struct part part, int cell,
                       struct loop *loop, struct face_list *faces)
{
    static const int edges[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                    {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};
    const struct generators *generators = assembly->generators;
    const struct cell *here = &assembly->triangulation->cell[cell];
    for (int e = 0; e < 6; e++) {
        const int *corner = edges[e]; // an even permutation
        if (assembly->triangulation->seen[cell] & OPPOSITE_EDGE[corner[2]][corner[3]])
            continue;
        const int32_t p = here->vertex[corner[0]], q = here->vertex[corner[1]];
        loop->forward = compare_generators(generators, p, q) < 0;
        struct row row = {0};
        if (is_face(generators, loop->forward ? p : q, loop->forward ? q : p, &row) &&
            walk_around_edge(assembly->triangulation, part, cell, corner[2], corner[3],
                             loop) &&
            loop->count >= 3) // else closed up on a wall
            append_face(faces, &row, loop);
    }
}

static void find_all(const struct assembly *assembly, bool periodic, int n_part,
                     struct face_list *lists)
{
    const int n_cell = assembly->triangulation->n_cell;
#pragma omp parallel for schedule(static, 1)
    for (int i = 0; i < n_part; i++) {
        const struct part part = {(int)((int64_t)n_cell * i / n_part),
                                  (int)((int64_t)n_cell * (i + 1) / n_part)};
        struct loop loop = {0};
        if (periodic) lists[i].image = NEW_ARRAY(struct image, 1);
        for (int c = part.begin; c < part.end; c++) {
            expect_neighbours(assembly->triangulation, c);
            if (assembly->triangulation->node[c] >= 0)
                find_faces(assembly, part, c, &loop, &lists[i]);
        }
        free(loop.node);
        free(loop.image);
    }
}

// The rows of all lists.
static struct row *join(struct face_list *lists, int n_part, int *count)
{
    *count = 0;
    for (int i = 0; i < n_part; i++)
        *count += lists[i].count;
    struct row *row = reallocate(lists[0].row, (size_t)*count, sizeof *row);
    for (int i = 0, to = 0; i < n_part; to += lists[i++].count) {
        if (i > 0) memcpy(row + to, lists[i].row, (size_t)lists[i].count * sizeof *row);
        for (int f = 0; f < lists[i].count; f++)
            row[to + f].key[3] = i;
        if (i > 0) free(lists[i].row);
    }
    return row;
}

static void store_face(const struct face_list *list, const struct row *row, int f,
                       struct network *network)
{
    const int64_t to = network->face_offset[f];
    const size_t corners = (size_t)row->key[4];
    memcpy(network->face_nodes + to, list->node + row->item, corners * sizeof(int32_t));
    network->face_particles[f][0] = row->key[0];
    network->face_particles[f][1] = row->key[1];
    if (!list->image) return;
    network->face_image[f] = numbered_image(row->key[2]);
    memcpy(network->face_node_image + to, list->image + row->item,
           corners * sizeof(struct image));
}

static void allocate_faces(struct network *network, const struct row *row,
                           const int32_t *order)
{
    enum { AHEAD = 32 };
    const int count = network->n_face;
    network->face_offset = NEW_ARRAY(int64_t, count + 1);
    for (int f = 0; f < count; f++) {
        __builtin_prefetch(&row[order[f + AHEAD < count ? f + AHEAD : f]]);
        network->face_offset[f + 1] = network->face_offset[f] + row[order[f]].key[4];
    }
    const size_t n_node = (size_t)network->face_offset[count];
    network->face_nodes = allocate_uncleared(n_node, sizeof(int32_t));
    network->face_particles =
        allocate_uncleared((size_t)count, sizeof *network->face_particles);
    if (!is_periodic(&network->packing)) return;
    network->face_image = NEW_ARRAY(struct image, count);
    network->face_node_image = NEW_ARRAY(struct image, n_node);
}

// Stores the faces in the network, sorted by the grains they separate. Later rows are
// prefetched, since they are scattered in memory.
static void store(const struct face_list *lists, const struct row *row,
                  const int32_t *order, struct network *network)
{
    enum { AHEAD = 16 };
    const int count = network->n_face;
#pragma omp parallel for
    for (int f = 0; f < count; f++) {
        const struct row *later = &row[order[f + AHEAD < count ? f + AHEAD : f]];
        __builtin_prefetch(&row[order[f + 2 * AHEAD < count ? f + 2 * AHEAD : f]]);
        __builtin_prefetch(lists[later->key[3]].node + later->item);
        const struct row *face = &row[order[f]];
        store_face(&lists[face->key[3]], face, f, network);
    }
}

void assemble_faces(const struct assembly *assembly, struct network *network)
{
    const int n_part = omp_get_max_threads();
    struct face_list *lists = NEW_ARRAY(struct face_list, n_part);
    find_all(assembly, is_periodic(&network->packing), n_part, lists);
    struct row *row = join(lists, n_part, &network->n_face);
    int32_t *order = order_rows(row, network->n_face);
    allocate_faces(network, row, order);
    store(lists, row, order, network);
    for (int i = 0; i < n_part; i++) {
        free(lists[i].node);
        free(lists[i].image);
    }
    free(lists);
    free(order);
    free(row);
}
