// SPDX-License-Identifier: GPL-3.0-or-later
// What readers of networks share: empty networks, checks of throats and their ends, the
// box around the nodes and the walls that nodes lie on.
//
// Formats of pore networks differ in what they have; what artifacts need and a format
// has not is derived here in one way for all.
#include "formats/foreign.h"

#include "basics/memory.h"

#include <stdbool.h>
#include <stdlib.h>

static const double LARGEST_SIZE = 1e150; // what artifacts hold

// All zeros, without grains and faces: the network of another program has none.
struct network network_init(int n_node, int n_throat)
{
    struct network network = {.n_node = n_node,
                              .node_position = NEW_ARRAY(struct vector, n_node),
                              .node_walls = NEW_ARRAY(uint8_t, n_node),
                              .n_throat = n_throat,
                              .throat_radius = NEW_ARRAY(double, n_throat),
                              .throat_length = NEW_ARRAY(double, n_throat),
                              .throat_kind = NEW_ARRAY(uint8_t, n_throat),
                              .throat_volume = NEW_ARRAY(double, n_throat),
                              .face_offset = NEW_ARRAY(int64_t, 1),
                              .face_nodes = NEW_ARRAY(int32_t, 0),
                              .packing = {.position = NEW_ARRAY(struct vector, 0),
                                          .radius = NEW_ARRAY(double, 0)}};
    network.throat_nodes = allocate((size_t)n_throat, sizeof *network.throat_nodes);
    network.face_particles = allocate(0, sizeof *network.face_particles);
    network.packing.bond = allocate(0, sizeof *network.packing.bond);
    return network;
}

// The lower node first, as in artifacts.
static enum status check_ends(struct network *network, int t, struct reason *reason)
{
    int32_t *ends = network->throat_nodes[t];
    if (ends[0] > ends[1]) {
        const int32_t kept = ends[0];
        ends[0] = ends[1];
        ends[1] = kept;
    }
    if (ends[0] < 0 || ends[1] >= network->n_node)
        return refuse(reason, STATUS_BAD_DATA,
                      "throat %d: must join nodes from 0 to %d, joins %d and %d", t,
                      network->n_node - 1, ends[0], ends[1]);
    if (ends[0] == ends[1])
        return refuse(reason, STATUS_BAD_DATA, "throat %d: both ends are node %d", t,
                      ends[0]);
    return STATUS_OK;
}

// Sizes of 0 are let through: throats without clearance are shut by those who use them.
enum status check_network(struct network *network, struct reason *reason)
{
    for (int i = 0; i < network->n_node; i++)
        for (int axis = 0; axis < 3; axis++)
            if (!(fabs(component(network->node_position[i], axis)) <= LARGEST_SIZE))
                return refuse(reason, STATUS_BAD_DATA,
                              "node %d: must have a place, within 1e150 m", i);
    for (int t = 0; t < network->n_throat; t++) {
        const enum status status = check_ends(network, t, reason);
        if (status) return status;
        const double size[] = {network->throat_radius[t], network->throat_length[t],
                               throat_volume(network, t)};
        for (int k = 0; k < 3; k++)
            if (!(size[k] >= 0 && size[k] <= LARGEST_SIZE))
                return refuse(reason, STATUS_BAD_DATA,
                              "throat %d: its %s must be from 0 to 1e150, is %g", t,
                              (const char *[]){"radius", "length", "volume"}[k],
                              size[k]);
    }
    return STATUS_OK;
}

static double mean_length(const struct network *network)
{
    double sum = 0;
    for (int t = 0; t < network->n_throat; t++)
        sum += network->throat_length[t] / network->n_throat;
    return sum > 0 ? sum : 1;
}

// A flat network gets half a mean throat length on both sides.
void box_around_nodes(struct network *network)
{
    for (int axis = 0; axis < 3; axis++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int i = 0; i < network->n_node; i++) {
            low = fmin(low, component(network->node_position[i], axis));
            high = fmax(high, component(network->node_position[i], axis));
        }
        if (!(low < high)) {
            const double plane = low == high ? low : 0; // 0: there are no nodes
            low = plane - mean_length(network) / 2;
            high = plane + mean_length(network) / 2;
        }
        set_component(&network->packing.lower, axis, low);
        set_component(&network->packing.upper, axis, high);
    }
}

// By equality: the box was made from these numbers.
void find_walls(struct network *network)
{
    for (int i = 0; i < network->n_node; i++)
        for (int wall = 0; wall < WALL_COUNT; wall++)
            if (component(network->node_position[i], wall / 2) ==
                wall_position(&network->packing, wall))
                network->node_walls[i] |= (uint8_t)(1 << wall);
}

// A volume that is pi r^2 L for all throats says nothing new, and would stay when radii
// are drawn.
void drop_cylinder_volumes(struct network *network)
{
    double *volume = network->throat_volume;
    bool same = true;
    network->throat_volume = NULL;
    for (int t = 0; t < network->n_throat && same; t++)
        same = throat_volume(network, t) == volume[t];
    if (same)
        free(volume);
    else
        network->throat_volume = volume;
}
