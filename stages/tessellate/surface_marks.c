// SPDX-License-Identifier: GPL-3.0-or-later
// Which wall a node at the outer surface belongs to when cells beyond are left out [K
// 3.3.5]. For each grain beyond (one that does not stay and has a face with one that
// does),
//     outwards = sum of the area vectors of its faces with grains that stay, each
//                pointing to the grain beyond, m2,
//     cuts     = walls that cut its cell: on which it has faces,
// and the grain's wall is the one of `cuts` with the largest component of `outwards`
// along its outward normal. All nodes of these faces get its bit. A grain beyond that
// no wall cuts gives none; a node at faces with several grains beyond may get several.
//
// Trap: such nodes carry a wall's bit and do not lie on that wall. Who moves nodes
// along walls must look where they are (is_on_wall in merge-nodes/merge.c).
#include "surface_marks.h"

#include "basics/memory.h"
#include "throats_beside.h"

#include <stdlib.h>

// Walls that cut the cell of each grain (n_particle), as bits. The caller frees it.
static uint8_t *find_cuts(const struct network *network, bool layer)
{
    uint8_t *cuts = NEW_ARRAY(uint8_t, network->packing.n_particle);
    for (int f = 0; f < network->n_face; f++) {
        const int wall = -1 - network->face_particles[f][1];
        if (wall < 0 || (layer && wall / 2 == 1)) continue;
        cuts[network->face_particles[f][0]] |= (uint8_t)(1 << wall);
    }
    return cuts;
}

// Area vector of a face, pointing from its first side to its second.
static struct vector face_area(const struct network *network, int face)
{
    const int64_t begin = network->face_offset[face];
    const struct vector origin = face_corner(network, begin);
    struct vector area = {0};
    for (int64_t k = begin + 1; k + 1 < network->face_offset[face + 1]; k++)
        area = add(area, cross(subtract(face_corner(network, k), origin),
                               subtract(face_corner(network, k + 1), origin)));
    return scale(0.5, area);
}

// The one of the WALLS (bits) that OUTWARDS points to most. A round wall has no
// direction and is only taken if there is no flat one.
static int wall_faced(unsigned walls, struct vector outwards)
{
    int best = walls ? 31 - __builtin_clz(walls) : -1;
    double most = -INFINITY;
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        const double along = component(outwards, wall / 2) * (wall % 2 ? 1 : -1);
        if (!(walls >> wall & 1) || along <= most) continue;
        most = along;
        best = wall;
    }
    return best;
}

// If the face separates a grain that stays from one that does not, the latter; else -1.
static int grain_beyond(const struct network *network, const bool *stay, int face)
{
    const int32_t *side = network->face_particles[face];
    if (side[1] < 0 || stay[side[0]] == stay[side[1]]) return -1;
    return side[stay[side[0]]];
}

// The wall of each grain beyond, from all its faces together: a single face may be too
// small to have a reliable direction.
static int *find_walls(const struct network *network, const bool *stay, bool layer)
{
    const int n = network->packing.n_particle;
    uint8_t *cuts = find_cuts(network, layer);
    struct vector *outwards = NEW_ARRAY(struct vector, n);
    for (int f = 0; f < network->n_face; f++) {
        const int grain = grain_beyond(network, stay, f);
        if (grain < 0) continue;
        const double sign = grain == network->face_particles[f][1] ? 1 : -1;
        outwards[grain] = add(outwards[grain], scale(sign, face_area(network, f)));
    }
    int *wall = NEW_ARRAY(int, n);
    for (int i = 0; i < n; i++)
        wall[i] = wall_faced(cuts[i], outwards[i]);
    free(outwards);
    free(cuts);
    return wall;
}

// Bits are added to those that nodes have: they may lie on other walls as well.
void face_walls(struct network *network, const bool *stay, bool layer)
{
    int *wall = find_walls(network, stay, layer);
    for (int f = 0; f < network->n_face; f++) {
        const int grain = grain_beyond(network, stay, f);
        if (grain < 0 || wall[grain] < 0) continue;
        for (int64_t k = network->face_offset[f]; k < network->face_offset[f + 1]; k++)
            network->node_walls[network->face_nodes[k]] |= (uint8_t)(1 << wall[grain]);
    }
    free(wall);
}

// Nothing to mark without auxiliary grains. Throats first: their marks need no walls.
void mark_boundary_layer(struct network *network, bool layer)
{
    const struct packing *packing = &network->packing;
    if (!packing->kind) return;
    bool *stay = NEW_ARRAY(bool, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++)
        stay[i] = !is_auxiliary(packing, i);
    bool *beside = throats_beside(network, stay);
    for (int t = 0; t < network->n_throat; t++)
        if (!beside[t]) network->throat_kind[t] = THROAT_BOUNDARY_LAYER;
    face_walls(network, stay, layer);
    free(beside);
    free(stay);
}
