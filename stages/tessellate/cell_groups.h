// SPDX-License-Identifier: GPL-3.0-or-later
// Which cells may have their nodes in one place.
#ifndef CRAQUELURE_CELL_GROUPS_H
#define CRAQUELURE_CELL_GROUPS_H

#include "generators.h"
#include "geometry/regular_triangulation.h"

// Cells with a grain among their corners, by the first base of their names: those of
// generator i, which is that base, from offset[i] to offset[i + 1], ascending. Their
// places come in the order of bases instead: those of base b from place[b] on.
struct cell_groups {
    int n, largest;
    int *offset; // (n + 2), the last but one is the end
    int *place;  // (n_base + 1)
    int32_t *cell;
};

// Notes the generators that cells go with as their nodes. The caller frees with
// cell_groups_free.
struct cell_groups group_cells(const struct generators *generators,
                               struct triangulation *triangulation);
void cell_groups_free(struct cell_groups *groups);

#endif
