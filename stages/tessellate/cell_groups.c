// SPDX-License-Identifier: GPL-3.0-or-later
// Groups cells by a counting sort over their first corner: the corner of the lowest
// base, taken at that base, so that all copies of a cell fall in one group. Cells
// without a grain among their corners are left out: they have no node that is wanted.
//     first_corner    the corner with the lowest base; -1 for cells left out;
//     base            from that corner, which may be a copy, to the generator itself;
//     number_places   where the nodes of each base begin: an upper bound, as cells of a
//                     group may share a node;
//     filling         cells in the order of the triangulation, so ascending in a group.
// Cells that share a node by being copies of each other are in one group; so a group
// can be looked at by itself, by one thread. O(cells + generators).
#include "cell_groups.h"

#include "basics/memory.h"

#include <stdlib.h>

// Whether generator I is a grain or a reflection itself, in no other image.
static bool is_base(const struct generators *generators, int32_t i)
{
    return !has_copies(generators) ||
           same_image(generators->origin[i].image, (struct image){0});
}

// The generator that is each base itself, not a copy.
static int32_t *find_bases(const struct generators *generators)
{
    int32_t *base = NEW_ARRAY(int32_t, generators->n_base);
    for (int i = 0; i < generators->n; i++)
        if (is_base(generators, i)) base[generators->origin[i].base] = i;
    return base;
}

// The corner of a cell with the lowest base; -1 when no corner is a grain.
static int32_t first_corner(const struct generators *generators,
                            const int32_t vertex[4])
{
    int32_t first = vertex[0];
    bool near = false;
    for (int k = 0; k < 4; k++) {
        near |= is_grain(generators, vertex[k]);
        if (generators->origin[vertex[k]].base < generators->origin[first].base)
            first = vertex[k];
    }
    return near ? first : -1;
}

static void number_places(const struct generators *generators,
                          struct cell_groups *groups)
{
    for (int i = 0; i < generators->n; i++) {
        const int count = groups->offset[i + 2];
        if (count) groups->place[generators->origin[i].base + 1] = count;
        if (count > groups->largest) groups->largest = count;
    }
    for (int base = 0; base < generators->n_base; base++)
        groups->place[base + 1] += groups->place[base];
}

struct cell_groups group_cells(const struct generators *generators,
                               struct triangulation *triangulation)
{
    const int n = generators->n, n_cell = triangulation->n_cell;
    struct cell_groups groups = {.n = n,
                                 .offset = NEW_ARRAY(int, n + 2),
                                 .place = NEW_ARRAY(int, generators->n_base + 1)};
    int32_t *base = has_copies(generators) ? find_bases(generators) : NULL;
    for (int c = 0; c < n_cell; c++) {
        int32_t first = first_corner(generators, triangulation->cell[c].vertex);
        if (base && first >= 0) first = base[generators->origin[first].base];
        if (first >= 0) groups.offset[first + 2]++;
        triangulation->node[c] = first;
    }
    free(base);
    number_places(generators, &groups);
    // Filling moves each offset one on, so that group i ends where i + 1 begins.
    for (int i = 0; i < n; i++)
        groups.offset[i + 2] += groups.offset[i + 1];
    groups.cell = allocate_uncleared((size_t)groups.offset[n + 1], sizeof(int32_t));
    for (int c = 0; c < n_cell; c++)
        if (triangulation->node[c] >= 0)
            groups.cell[groups.offset[triangulation->node[c] + 1]++] = c;
    return groups;
}

void cell_groups_free(struct cell_groups *groups)
{
    free(groups->offset);
    free(groups->place);
    free(groups->cell);
}
