// SPDX-License-Identifier: GPL-3.0-or-later
// JSON Graph Format (jsongraphformat.info), version 1, with the names that OpenPNM
// reads and writes (openpnm.io.network_from_jsongraph, network_to_jsongraph):
//     graph.metadata.number_of_nodes, number_of_links
//     graph.nodes[].id, .metadata.node_coordinates.{x,y,z}, .node_squared_radius
//     graph.edges[].id, .source, .target, .metadata.link_length, .link_squared_radius
// Metadata may hold more. We add link_radius, link_volume, link_kind and node_walls,
// and all that is not a graph (box, grains, bonds, faces) as graph.metadata.craquelure,
// so that a network comes back as it was.
#pragma once

#include "basics/status.h"
#include "network/network.h"

#include <jansson.h>

// Nodes have no volume and so no radius [K 3.3.4]: theirs is that of their widest
// throat. The caller owns the document.
json_t *jsongraph_from_network(const struct network *network);

// On success the caller frees *NETWORK. STATUS_BAD_DATA: not of this format, or not a
// network. A document without our additions gives a network without grains and faces,
// in the box around its nodes.
enum status network_from_jsongraph(const json_t *document, struct network *network,
                                   struct reason *reason);
