// SPDX-License-Identifier: GPL-3.0-or-later
// What touches a wall, and what hangs on it by bonds. With `inwards` the distance of a
// centre from the wall, into the box,
//     touches:  inwards <= (1 + 1e-6) radius,
// so that rounding parts no grain from its wall, and a grain beyond the wall counts.
//
// Bonded pieces are found as disjoint sets whose root is the lowest grain, so the
// numbers do not depend on the order of the bonds. All bonds of the packing count: it
// does not know which have broken. A piece counts as supported, with all its grains, if
// one of them is marked. O(n_particle + n_bond), nearly.
#include "geometry/support.h"

#include "basics/disjoint_sets.h"
#include "basics/memory.h"

#include <stdlib.h>

static const double TOUCHING_GAP = 1e-6; // of the radius

bool touches_walls(const struct packing *packing, int grain, unsigned walls)
{
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        const double x = component(packing->position[grain], wall / 2);
        const double at = wall_position(packing, wall);
        const double inwards = wall % 2 ? at - x : x - at;
        if (walls >> wall & 1 && inwards <= (1 + TOUCHING_GAP) * packing->radius[grain])
            return true;
    }
    return false;
}

int *bonded_pieces(const struct packing *packing)
{
    int *piece = NEW_ARRAY(int, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++)
        piece[i] = i;
    for (int b = 0; b < packing->n_bond; b++)
        unite_sets(piece, packing->bond[b][0], packing->bond[b][1]);
    for (int i = 0; i < packing->n_particle; i++)
        piece[i] = set_root(piece, i);
    return piece;
}

int count_supported(const struct packing *packing, const uint8_t *holds)
{
    const int n = packing->n_particle;
    int *piece = bonded_pieces(packing);
    uint8_t *held = NEW_ARRAY(uint8_t, n);
    for (int i = 0; i < n; i++)
        if (holds[i]) held[piece[i]] = 1;
    int count = 0;
    for (int i = 0; i < n; i++)
        count += held[piece[i]];
    free(held);
    free(piece);
    return count;
}
