// SPDX-License-Identifier: GPL-3.0-or-later
// The four text files that Statoil's and Imperial College's network codes share, as
// OpenPNM documents and reads them (openpnm.io.network_from_statoil). Numbers in
// columns, counted from 1, m and m3, nodes -1 and 0 for the reservoirs at the inlet
// (the wall -x) and the outlet (+x):
//     PREFIX_node1.dat  n, box edges; then: number, x, y, z, throats, their other ends,
//                       at the inlet, at the outlet, the throats
//     PREFIX_node2.dat  number, volume, radius, shape factor, clay
//     PREFIX_link1.dat  n; then: number, two nodes, radius, shape factor, length in all
//     PREFIX_link2.dat  number, two nodes, length of each node, of the throat, volume,
//                       clay
// A network keeps its nodes and throats with radii, lengths and volumes. The format
// has no place for grains, faces, and throats' kinds; the box begins at the origin.
#pragma once

#include "basics/status.h"
#include "network/network.h"

enum { STATOIL_NODE1, STATOIL_NODE2, STATOIL_LINK1, STATOIL_LINK2, STATOIL_FILES };
extern const char *const statoil_endings[STATOIL_FILES]; // "_node1.dat", …

// The text of each file; the caller frees them. Nodes have no volume [K 3.3.4]; their
// radius is that of their widest throat. Nodes in the walls -x and +x are joined to the
// reservoirs by throats of no length and volume.
void statoil_from_network(const struct network *network, char *text[STATOIL_FILES]);

// The network that three of the files describe (node2 says nothing that a throat has);
// throats to reservoirs are left out. On success the caller frees *NETWORK.
// STATUS_BAD_DATA: names the file's ending and the line.
enum status network_from_statoil(const char *const text[STATOIL_FILES],
                                 struct network *network, struct reason *reason);
