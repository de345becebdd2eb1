// SPDX-License-Identifier: GPL-3.0-or-later
// Fragments by union-find over the intact bonds, at any time that INTACT is of: before
// drying, at the end, at a snapshot. Each is counted at its root, which is its lowest
// grain, so results do not depend on the order of the bonds. A bond across a periodic
// side joins its grains like any other. A single grain is a fragment too.
//
// Auxiliary grains do not count: a root of none but such grains has the size 0 and is
// no fragment. O(grains + bonds), nearly.
#include "fragment_counts.h"

#include "basics/disjoint_sets.h"

#include <stdlib.h>

int *fragment_sizes(const struct packing *packing, const uint8_t *joins, int *root)
{
    int *size = NEW_ARRAY(int, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++)
        root[i] = i;
    for (int b = 0; b < packing->n_bond; b++)
        if (joins[b]) unite_sets(root, packing->bond[b][0], packing->bond[b][1]);
    for (int i = 0; i < packing->n_particle; i++) {
        root[i] = set_root(root, i);
        if (!is_auxiliary(packing, i)) size[root[i]]++;
    }
    return size;
}

uint8_t *largest_fragment(const struct packing *packing, const uint8_t *intact)
{
    int *root = NEW_ARRAY(int, packing->n_particle);
    int *size = fragment_sizes(packing, intact, root);
    int largest = 0;
    for (int i = 1; i < packing->n_particle; i++)
        if (size[i] > size[largest]) largest = i;
    uint8_t *is_in = NEW_ARRAY(uint8_t, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++)
        is_in[i] = root[i] == largest && !is_auxiliary(packing, i);
    free(root);
    free(size);
    return is_in;
}

struct fragment_counts count_fragments(const struct packing *packing,
                                       const uint8_t *intact, struct sizes *sizes)
{
    int *root = NEW_ARRAY(int, packing->n_particle);
    int *size = fragment_sizes(packing, intact, root);
    struct fragment_counts found = {0};
    for (int i = 0; i < packing->n_particle; i++) {
        if (size[i] == 0) continue;
        found.count++;
        found.single += size[i] == 1;
        if (size[i] > found.largest) found.largest = size[i];
        if (sizes) add_size(sizes, size[i]);
    }
    free(root);
    free(size);
    return found;
}
