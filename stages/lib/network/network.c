// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/network.h"

#include "basics/memory.h"

#include <stdlib.h>

void network_free(struct network *network)
{
    packing_free(&network->packing);
    free(network->node_position);
    free(network->node_walls);
    free(network->throat_nodes);
    free(network->throat_radius);
    free(network->throat_length);
    free(network->throat_kind);
    free(network->throat_volume);
    free(network->face_offset);
    free(network->face_nodes);
    free(network->face_particles);
    free(network->throat_image);
    free(network->face_image);
    free(network->face_node_image);
    *network = (struct network){0};
}

struct incidence network_incidence(const struct network *network)
{
    struct incidence incidence = {.offset = NEW_ARRAY(int, network->n_node + 1),
                                  .throat =
                                      NEW_ARRAY(int, 2 * (size_t)network->n_throat)};
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2; end++)
            incidence.offset[network->throat_nodes[t][end] + 1]++;
    for (int i = 0; i < network->n_node; i++)
        incidence.offset[i + 1] += incidence.offset[i];

    int *next = duplicate(incidence.offset, (size_t)network->n_node + 1, sizeof *next);
    for (int t = 0; t < network->n_throat; t++)
        for (int end = 0; end < 2; end++)
            incidence.throat[next[network->throat_nodes[t][end]]++] = t;
    free(next);
    return incidence;
}

void incidence_free(struct incidence *incidence)
{
    free(incidence->offset);
    free(incidence->throat);
    *incidence = (struct incidence){0};
}

int throat_between(const struct network *network, const struct incidence *incidence,
                   int a, int b)
{
    const int lower = a < b ? a : b, upper = a < b ? b : a;
    for (int k = incidence->offset[lower]; k < incidence->offset[lower + 1]; k++) {
        const int t = incidence->throat[k];
        if (network->throat_nodes[t][0] == lower &&
            network->throat_nodes[t][1] == upper)
            return t;
    }
    return -1;
}

double throat_volume(const struct network *network, int throat)
{
    if (network->throat_volume) return network->throat_volume[throat];
    const double radius = network->throat_radius[throat];
    return M_PI * radius * radius * network->throat_length[throat];
}
