// SPDX-License-Identifier: GPL-3.0-or-later
// Removal of parts of a network: what is kept is marked first, then nodes, throats and
// faces are compacted in place, in their old order. For the elimination
//     keep_grains           grains with a cell, no face on a wall, and not auxiliary;
//     face_walls            marks of the walls on nodes at cut cells, which must come
//                           while the faces of those cells are still there;
//     keep_neighbours       faces of these grains, nodes of those faces, throats beside
//                           these grains;
//     keep_boundary_layer   throats of the boundary layer at those nodes, and their
//                           other nodes.
// A plane keeps what lies in the lower wall y: nodes with that bit, throats between two
// of them, faces on that wall.
//
// Grains are not removed: the packing of the network stays whole. Trap: throat_volume
// is not compacted, so volumes must be given afterwards, as tessellate does.
#include "remove_cells.h"

#include "basics/memory.h"
#include "surface_marks.h"
#include "throats_beside.h"

#include <stdlib.h>
#include <string.h>

// Marks of what is kept.
struct kept_parts {
    bool *grain, *face, *throat;
    int *node; // its new number; -1: removed
};

static bool is_along_y(int32_t side)
{
    return side < 0 && (-1 - side) / 2 == 1;
}

// Marks the grains whose cells stay; returns how many.
static int keep_grains(const struct network *network, bool layer, bool *kept)
{
    bool *cut = NEW_ARRAY(bool, network->packing.n_particle);
    for (int f = 0; f < network->n_face; f++) {
        const int32_t *side = network->face_particles[f];
        kept[side[0]] = true;
        if (side[1] >= 0)
            kept[side[1]] = true;
        else if (!layer || !is_along_y(side[1]))
            cut[side[0]] = true;
    }
    int count = 0;
    for (int i = 0; i < network->packing.n_particle; i++)
        count += kept[i] = kept[i] && !cut[i] && !is_auxiliary(&network->packing, i);
    free(cut);
    return count;
}

static void keep_neighbours(const struct network *network, struct kept_parts *kept)
{
    for (int f = 0; f < network->n_face; f++) {
        const int32_t *side = network->face_particles[f];
        kept->face[f] = kept->grain[side[0]] || (side[1] >= 0 && kept->grain[side[1]]);
        if (!kept->face[f]) continue;
        for (int64_t k = network->face_offset[f]; k < network->face_offset[f + 1]; k++)
            kept->node[network->face_nodes[k]] = 0;
    }
    free(kept->throat);
    kept->throat = throats_beside(network, kept->grain);
}

// Keeps throats of the boundary layer that begin at a node that is kept.
static void keep_boundary_layer(const struct network *network, struct kept_parts *kept)
{
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *ends = network->throat_nodes[t];
        kept->throat[t] |= network->throat_kind[t] == THROAT_BOUNDARY_LAYER &&
                           (kept->node[ends[0]] >= 0 || kept->node[ends[1]] >= 0);
    }
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2 && kept->throat[t]; end++)
            kept->node[network->throat_nodes[t][end]] = 0;
}

void compact_nodes(struct network *network, int *number)
{
    int n = 0;
    for (int i = 0; i < network->n_node; i++) {
        if (number[i] < 0) continue;
        network->node_position[n] = network->node_position[i];
        network->node_walls[n] = network->node_walls[i];
        number[i] = n++;
    }
    network->n_node = n;
}

static void compact_throats(struct network *network, const struct kept_parts *kept)
{
    int n = 0;
    for (int t = 0; t < network->n_throat; t++) {
        if (!kept->throat[t]) continue;
        for (int end = 0; end < 2; end++)
            network->throat_nodes[n][end] = kept->node[network->throat_nodes[t][end]];
        network->throat_radius[n] = network->throat_radius[t];
        network->throat_length[n] = network->throat_length[t];
        network->throat_kind[n] = network->throat_kind[t];
        copy_throat_shape(network, t, n);
        if (network->throat_image) network->throat_image[n] = network->throat_image[t];
        n++;
    }
    network->n_throat = n;
}

// Writing never overtakes reading, as faces only get fewer and corners with them.
static void compact_faces(struct network *network, const struct kept_parts *kept)
{
    int n = 0;
    int64_t to = 0;
    for (int f = 0; f < network->n_face; f++) {
        const int64_t begin = network->face_offset[f],
                      end = network->face_offset[f + 1];
        if (!kept->face[f]) continue;
        network->face_offset[n] = to;
        for (int64_t k = begin; k < end; k++, to++) {
            network->face_nodes[to] = kept->node[network->face_nodes[k]];
            if (network->face_node_image)
                network->face_node_image[to] = network->face_node_image[k];
        }
        memmove(network->face_particles[n], network->face_particles[f],
                sizeof *network->face_particles);
        if (network->face_image) network->face_image[n] = network->face_image[f];
        n++;
    }
    network->face_offset[n] = to;
    network->n_face = n;
}

static struct kept_parts keep_nothing(const struct network *network)
{
    struct kept_parts kept = {.grain = NEW_ARRAY(bool, network->packing.n_particle),
                              .face = NEW_ARRAY(bool, network->n_face),
                              .throat = NEW_ARRAY(bool, network->n_throat),
                              .node = NEW_ARRAY(int, network->n_node)};
    for (int i = 0; i < network->n_node; i++)
        kept.node[i] = -1;
    return kept;
}

// Removes all that is not kept from the network; frees KEPT.
static void remove_rest(struct network *network, struct kept_parts *kept)
{
    compact_nodes(network, kept->node);
    compact_throats(network, kept);
    compact_faces(network, kept);
    free(kept->grain);
    free(kept->face);
    free(kept->throat);
    free(kept->node);
}

int eliminate_cut_cells(struct network *network, bool layer)
{
    struct kept_parts kept = keep_nothing(network);
    const int count = keep_grains(network, layer, kept.grain);
    face_walls(network, kept.grain, layer);
    keep_neighbours(network, &kept);
    keep_boundary_layer(network, &kept);
    remove_rest(network, &kept);
    return count;
}

void reduce_to_plane(struct network *network)
{
    struct kept_parts kept = keep_nothing(network);
    for (int i = 0; i < network->n_node; i++)
        if (network->node_walls[i] & WALL_Y_LOWER) kept.node[i] = 0;
    for (int t = 0; t < network->n_throat; t++)
        kept.throat[t] = kept.node[network->throat_nodes[t][0]] >= 0 &&
                         kept.node[network->throat_nodes[t][1]] >= 0;
    for (int f = 0; f < network->n_face; f++)
        kept.face[f] = network->face_particles[f][1] == -3; // the lower wall y
    remove_rest(network, &kept);
    for (int i = 0; i < network->n_node; i++) // a wall of the box, not of the layer
        network->node_walls[i] &= (uint8_t)~WALL_Y_LOWER;
}
