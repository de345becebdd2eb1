// SPDX-License-Identifier: GPL-3.0-or-later
// Faces: what separates two grains, or a grain from a wall, dual to the edges of the
// triangulation.
#include "assemble.h"

#include "basics/memory.h"

#include <stdlib.h>

enum { MOST_AROUND = 1 << 20 }; // cells around one edge; more means broken links

struct loop {
    int32_t *node;
    int count, capacity;
};

static int place_of(const int32_t cell[4], int32_t point)
{
    for (int k = 0; k < 4; k++)
        if (cell[k] == point) return k;
    return -1;
}

// Turns around the edge P-Q of cell START and gathers the nodes passed. False when
// START is not the lowest cell around the edge (each edge is to be met once), or the
// way leaves the finite cells.
static bool turn_around(const struct assembly *assembly, int start, int32_t p,
                        int32_t q, struct loop *loop)
{
    const struct triangulation *cells = assembly->triangulation;
    int cell = start,
        through = -1; // through: the corner the next step goes opposite of
    for (int k = 0; k < 4 && through < 0; k++)
        if (cells->vertex[start][k] != p && cells->vertex[start][k] != q) through = k;
    loop->count = 0;
    do {
        const int32_t node = assembly->nodes->of_cell[cell];
        if (!loop->count || loop->node[loop->count - 1] != node) {
            GROW_ARRAY(loop->node, loop->count, loop->capacity);
            loop->node[loop->count++] = node;
        }
        // Leave opposite THROUGH; the next way out is opposite the corner that stays.
        int32_t stays = -1;
        for (int k = 0; k < 4; k++) {
            const int32_t point = cells->vertex[cell][k];
            if (k != through && point != p && point != q) stays = point;
        }
        cell = cells->neighbour[cell][through];
        if (cell < start || loop->count > MOST_AROUND) return cell == start;
        through = place_of(cells->vertex[cell], stays);
    } while (cell != start);
    while (loop->count > 1 && loop->node[loop->count - 1] == loop->node[0])
        loop->count--;
    return true;
}

// Whose face it is: a grain and a grain, or a grain and the wall it is reflected in.
static bool is_face(const struct generators *generators, int32_t p, int32_t q,
                    int32_t sides[2])
{
    const int32_t grain = p < q ? p : q,
                  other = p < q ? q : p; // images come after grains
    if (grain >= generators->n_particle) return false;
    sides[0] = grain;
    sides[1] = other < generators->n_particle ? other : -1 - generators->wall[other];
    return sides[1] >= 0 || generators->particle[other] == grain;
}

// The loop runs counter-clockwise seen from generator TO: its normal points there from
// generator FROM, also where FROM lies beyond its own face.
static void orient(const struct assembly *assembly, int32_t from, int32_t to,
                   struct loop *loop)
{
    const struct vector *position = assembly->nodes->position;
    const struct vector origin = position[loop->node[0]];
    struct vector area = {0};
    for (int k = 1; k + 1 < loop->count; k++)
        area = add(area, cross(subtract(position[loop->node[k]], origin),
                               subtract(position[loop->node[k + 1]], origin)));
    const struct vector out = subtract(assembly->generators->position[to],
                                       assembly->generators->position[from]);
    if (dot(area, out) >= 0) return;
    for (int a = 1, b = loop->count - 1; a < b; a++, b--) {
        const int32_t kept = loop->node[a];
        loop->node[a] = loop->node[b];
        loop->node[b] = kept;
    }
}

struct face_list {
    int32_t (*sides)[2];
    int64_t *offset;
    int32_t *nodes;
    int count, sides_capacity, offset_capacity;
    size_t n_node, node_capacity;
};

static void append_face(struct face_list *faces, const int32_t sides[2],
                        const struct loop *loop)
{
    GROW_ARRAY(faces->sides, faces->count, faces->sides_capacity);
    GROW_ARRAY(faces->offset, faces->count, faces->offset_capacity);
    faces->sides[faces->count][0] = sides[0];
    faces->sides[faces->count][1] = sides[1];
    faces->offset[faces->count++] = (int64_t)faces->n_node;
    for (int k = 0; k < loop->count; k++) {
        GROW_ARRAY(faces->nodes, faces->n_node, faces->node_capacity);
        faces->nodes[faces->n_node++] = loop->node[k];
    }
}

struct face_place {
    int32_t sides[2];
    int at;
};

static int compare_places(const void *a, const void *b)
{
    const struct face_place *first = a, *second = b;
    for (int side = 0; side < 2; side++)
        if (first->sides[side] != second->sides[side])
            return first->sides[side] < second->sides[side] ? -1 : 1;
    return (first->at > second->at) - (first->at < second->at);
}

// Into the network, by the grains they separate.
static void store_sorted(const struct face_list *faces, struct network *network)
{
    struct face_place *places = NEW_ARRAY(struct face_place, faces->count);
    for (int f = 0; f < faces->count; f++)
        places[f] = (struct face_place){{faces->sides[f][0], faces->sides[f][1]}, f};
    qsort(places, (size_t)faces->count, sizeof *places, compare_places);

    network->n_face = faces->count;
    network->face_offset = NEW_ARRAY(int64_t, faces->count + 1);
    network->face_nodes = NEW_ARRAY(int32_t, faces->n_node);
    network->face_particles =
        allocate((size_t)faces->count, sizeof *network->face_particles);
    for (int f = 0; f < faces->count; f++) {
        const int from = places[f].at;
        const int64_t begin = faces->offset[from];
        const int64_t end =
            from + 1 < faces->count ? faces->offset[from + 1] : (int64_t)faces->n_node;
        network->face_offset[f + 1] = network->face_offset[f] + end - begin;
        for (int64_t k = begin; k < end; k++)
            network->face_nodes[network->face_offset[f] + k - begin] = faces->nodes[k];
        network->face_particles[f][0] = places[f].sides[0];
        network->face_particles[f][1] = places[f].sides[1];
    }
    free(places);
}

void assemble_faces(const struct assembly *assembly, struct network *network)
{
    static const int edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    struct face_list faces = {0};
    struct loop loop = {0};
    for (int c = 0; c < assembly->triangulation->n_cell; c++)
        for (int e = 0; e < 6; e++) {
            const int32_t p = assembly->triangulation->vertex[c][edges[e][0]];
            const int32_t q = assembly->triangulation->vertex[c][edges[e][1]];
            int32_t sides[2];
            if (!is_face(assembly->generators, p, q, sides)) continue;
            if (!turn_around(assembly, c, p, q, &loop)) continue;
            if (loop.count < 3) continue; // closed up on a wall
            orient(assembly, p < q ? p : q, p < q ? q : p, &loop);
            append_face(&faces, sides, &loop);
        }
    store_sorted(&faces, network);
    free(loop.node);
    free(faces.sides);
    free(faces.offset);
    free(faces.nodes);
}
