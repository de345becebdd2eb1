// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of cells that may share a node, as copies of each other in a periodic box do:
// such cells have the same bases, and so the same lowest one.
#pragma once

#include "generators.h"
#include "geometry/triangulation/regular_triangulation.h"

// Cells with a grain among their corners, grouped by the lowest base of their corners:
// those of generator i, which is that base, from offset[i] to offset[i + 1], ascending.
// The places of their nodes are in the order of bases: those of base b from place[b]
// on.
struct cell_groups {
    int n, largest;
    int *offset; // (n + 2), the last but one is the end
    int *place;  // (n_base + 1)
    int32_t *cell;
};

// Also writes the group of each cell to triangulation->node, -1 for none. The caller
// frees the result with cell_groups_free. O(cells). Each group may be looked at by a
// thread of its own.
struct cell_groups group_cells(const struct generators *generators,
                               struct triangulation *triangulation);
void cell_groups_free(struct cell_groups *groups);
