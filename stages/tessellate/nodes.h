// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes of the diagram: where the power to four generators is equal.
#ifndef CRAQUELURE_NODES_H
#define CRAQUELURE_NODES_H

#include "mirrored.h"
#include "regular_triangulation.h"

struct nodes {
    int n;
    struct vector *position; // (n) mean diameters, exactly on the walls they lie on
    uint8_t *walls;          // (n) bits of enum wall
    int *of_cell; // (n_cell) node of each tetrahedron, -1 if no grain is near
    double farthest_outside; // how far any node lies outside the box, mean diameters
};

// Nodes of the tetrahedra that have a grain among their corners. Those that coincide on
// a wall are one. The caller frees with nodes_free.
struct nodes find_nodes(const struct generators *generators,
                        const struct triangulation *triangulation);
void nodes_free(struct nodes *nodes);

#endif
