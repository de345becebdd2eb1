// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes of the diagram: the points of equal power to four generators [K 3.3.4].
#pragma once

#include "generators.h"
#include "geometry/triangulation/regular_triangulation.h"

struct nodes {
    int n;
    struct vector *position; // (n) in units, exactly on the walls they lie on,
                             // and inside the box where it repeats
    uint8_t *walls;          // (n) bits of enum wall
    bool complete; // no image that was left out could have changed the cell of a grain
};

// Gives each cell with a grain among its corners its node: fills triangulation->node
// and ->image, and NODES in the order of the grains they lie between. Nodes that
// coincide on a wall are one, and so are copies of each other. STATUS_BAD_DATA when a
// periodic box is too narrow. The caller frees with nodes_free. COMPLETE false is no
// failure: the caller takes more images and starts again (diagram.c).
enum status find_nodes(const struct generators *generators,
                       struct triangulation *triangulation, struct nodes *nodes,
                       struct reason *reason);
void nodes_free(struct nodes *nodes);
