// SPDX-License-Identifier: GPL-3.0-or-later
// A search from the open nodes along throats of the network; what it does not reach is
// enclosed, and its throats count as emptied from outside. Breadth first, in O(nodes +
// throats): `queue` holds each node reached once, in the order of its reaching. A
// throat that is not of the network (closed, or imposed empty) is no way. One end tells
// for a throat, as both ends of an open throat are reached or neither is. Without an
// open node nothing is enclosed: there is no outside to ask from.
#include "network/enclosed.h"

#include "basics/memory.h"

#include <stdlib.h>

static void spread(const struct network *network, const struct incidence *incidence,
                   bool *reached, int *queue, int n)
{
    for (int k = 0; k < n; k++)
        for (int i = incidence->offset[queue[k]]; i < incidence->offset[queue[k] + 1];
             i++) {
            const int t = incidence->throat[i];
            if (network->throat_kind[t] != THROAT_NETWORK) continue;
            const int32_t *ends = network->throat_nodes[t];
            const int other = ends[ends[0] == queue[k]];
            if (reached[other]) continue;
            reached[other] = true;
            queue[n++] = other;
        }
}

int empty_enclosed_throats(struct network *network, const bool *open)
{
    bool *reached = NEW_ARRAY(bool, network->n_node);
    int *queue = NEW_ARRAY(int, network->n_node);
    int n = 0;
    for (int i = 0; i < network->n_node; i++)
        if (open[i]) reached[queue[n++] = i] = true;
    struct incidence incidence = network_incidence(network);
    spread(network, &incidence, reached, queue, n);
    incidence_free(&incidence);

    int enclosed = 0;
    for (int t = 0; t < network->n_throat && n > 0; t++) {
        if (network->throat_kind[t] != THROAT_NETWORK ||
            reached[network->throat_nodes[t][0]])
            continue;
        network->throat_kind[t] = THROAT_IMPOSED_EMPTY;
        enclosed++;
    }
    free(queue);
    free(reached);
    return enclosed;
}

int empty_throats_cut_off(struct network *network, unsigned open_walls)
{
    bool *open = NEW_ARRAY(bool, network->n_node);
    for (int i = 0; i < network->n_node; i++)
        open[i] = network->node_walls[i] & open_walls;
    const int enclosed = empty_enclosed_throats(network, open);
    free(open);
    return enclosed;
}
