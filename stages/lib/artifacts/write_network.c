// SPDX-License-Identifier: GPL-3.0-or-later
// The datasets first, then the numbers of /summary, then the ParaView view, in which a
// throat that leads around a periodic box is drawn as a point.
//
//     coordination = 2 n_throat / n_node     throats at a node, on average
//     void_volume = sum of throat_volume     m3, of throats of any kind
//     unmerged_throats, unmerged_length      only where throats were merged
#include "artifacts/write_network.h"

#include <stdlib.h>

static void put_drawing(struct artifact *artifact, const struct network *network)
{
    int32_t(*drawn)[2] = network->throat_image ? drawn_throats(network) : NULL;
    artifact_put_vtk(
        artifact, "/nodes/position", network->n_node,
        (const char *const[]){"/nodes/kind", NULL},
        (const int32_t(*)[2])(drawn ? drawn : network->throat_nodes), network->n_throat,
        (const char *const[]){"/throats/radius", "/throats/kind",
                              network->throat_volume ? "/throats/volume" : NULL, NULL});
    free(drawn);
}

void put_network_with_summary(struct artifact *artifact, const struct network *network)
{
    double void_volume = 0;
    for (int t = 0; t < network->n_throat; t++)
        void_volume += throat_volume(network, t);

    artifact_put_network(artifact, network);
    artifact_put_number(artifact, "/summary/coordination",
                        network->n_node ? 2.0 * network->n_throat / network->n_node
                                        : 0);
    artifact_put_number(artifact, "/summary/void_volume", void_volume);
    if (network->unmerged_throats) {
        artifact_put_number(artifact, "/summary/unmerged_throats",
                            network->unmerged_throats);
        artifact_put_number(artifact, "/summary/unmerged_length",
                            network->unmerged_length);
    }
    put_drawing(artifact, network);
}

void write_network_of(const struct network *network,
                      const struct invocation *invocation, json_t *inputs,
                      const char *model)
{
    struct artifact *artifact = artifact_create("network", invocation->output);
    put_network_with_summary(artifact, network);
    artifact_finish(artifact, invocation, inputs, model);
}

void write_network(const struct network *network, const struct invocation *invocation,
                   const struct artifact *input, const char *model)
{
    write_network_of(network, invocation, one_input(input), model);
}
