// SPDX-License-Identifier: GPL-3.0-or-later
#include "reduce.h"

#include "basics/memory.h"
#include "surface_marks.h"
#include "throats_beside.h"

#include <stdlib.h>
#include <string.h>

// What stays.
struct staying {
    bool *grain, *face, *throat;
    int *node; // its new number; -1: does not stay
};

static bool is_along_y(int32_t side)
{
    return side < 0 && (-1 - side) / 2 == 1;
}

static int choose_grains(const struct network *network, bool layer, bool *stays)
{
    bool *cut = NEW_ARRAY(bool, network->packing.n_particle);
    for (int f = 0; f < network->n_face; f++) {
        const int32_t *side = network->face_particles[f];
        stays[side[0]] = true;
        if (side[1] >= 0)
            stays[side[1]] = true;
        else if (!layer || !is_along_y(side[1]))
            cut[side[0]] = true;
    }
    int count = 0;
    for (int i = 0; i < network->packing.n_particle; i++)
        count += stays[i] = stays[i] && !cut[i] && !is_auxiliary(&network->packing, i);
    free(cut);
    return count;
}

static void choose_rest(const struct network *network, struct staying *stays)
{
    for (int f = 0; f < network->n_face; f++) {
        const int32_t *side = network->face_particles[f];
        stays->face[f] =
            stays->grain[side[0]] || (side[1] >= 0 && stays->grain[side[1]]);
        if (!stays->face[f]) continue;
        for (int64_t k = network->face_offset[f]; k < network->face_offset[f + 1]; k++)
            stays->node[network->face_nodes[k]] = 0;
    }
    free(stays->throat);
    stays->throat = throats_beside(network, stays->grain);
}

// The throats of the boundary layer that begin at what stays.
static void keep_feet(const struct network *network, struct staying *stays)
{
    for (int t = 0; t < network->n_throat; t++) {
        const int32_t *ends = network->throat_nodes[t];
        stays->throat[t] |= network->throat_kind[t] == THROAT_BOUNDARY_LAYER &&
                            (stays->node[ends[0]] >= 0 || stays->node[ends[1]] >= 0);
    }
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2 && stays->throat[t]; end++)
            stays->node[network->throat_nodes[t][end]] = 0;
}

void pack_nodes(struct network *network, int *number)
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

static void pack_throats(struct network *network, const struct staying *stays)
{
    int n = 0;
    for (int t = 0; t < network->n_throat; t++) {
        if (!stays->throat[t]) continue;
        for (int end = 0; end < 2; end++)
            network->throat_nodes[n][end] = stays->node[network->throat_nodes[t][end]];
        network->throat_radius[n] = network->throat_radius[t];
        network->throat_length[n] = network->throat_length[t];
        network->throat_kind[n] = network->throat_kind[t];
        if (network->throat_image) network->throat_image[n] = network->throat_image[t];
        n++;
    }
    network->n_throat = n;
}

static void pack_faces(struct network *network, const struct staying *stays)
{
    int n = 0;
    int64_t to = 0;
    for (int f = 0; f < network->n_face; f++) {
        const int64_t begin = network->face_offset[f],
                      end = network->face_offset[f + 1];
        if (!stays->face[f]) continue;
        network->face_offset[n] = to;
        for (int64_t k = begin; k < end; k++, to++) {
            network->face_nodes[to] = stays->node[network->face_nodes[k]];
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

static struct staying nothing_stays(const struct network *network)
{
    struct staying stays = {.grain = NEW_ARRAY(bool, network->packing.n_particle),
                            .face = NEW_ARRAY(bool, network->n_face),
                            .throat = NEW_ARRAY(bool, network->n_throat),
                            .node = NEW_ARRAY(int, network->n_node)};
    for (int i = 0; i < network->n_node; i++)
        stays.node[i] = -1;
    return stays;
}

// Leaves in the network what stays; frees STAYS.
static void leave(struct network *network, struct staying *stays)
{
    pack_nodes(network, stays->node);
    pack_throats(network, stays);
    pack_faces(network, stays);
    free(stays->grain);
    free(stays->face);
    free(stays->throat);
    free(stays->node);
}

int eliminate_cut_cells(struct network *network, bool layer)
{
    struct staying stays = nothing_stays(network);
    const int count = choose_grains(network, layer, stays.grain);
    face_walls(network, stays.grain, layer);
    choose_rest(network, &stays);
    keep_feet(network, &stays);
    leave(network, &stays);
    return count;
}

void reduce_to_plane(struct network *network)
{
    struct staying stays = nothing_stays(network);
    for (int i = 0; i < network->n_node; i++)
        if (network->node_walls[i] & WALL_Y_LOWER) stays.node[i] = 0;
    for (int t = 0; t < network->n_throat; t++)
        stays.throat[t] = stays.node[network->throat_nodes[t][0]] >= 0 &&
                          stays.node[network->throat_nodes[t][1]] >= 0;
    for (int f = 0; f < network->n_face; f++)
        stays.face[f] = network->face_particles[f][1] == -3; // the lower wall y
    leave(network, &stays);
    for (int i = 0; i < network->n_node; i++) // a wall of the box, not of the layer
        network->node_walls[i] &= (uint8_t)~WALL_Y_LOWER;
}
