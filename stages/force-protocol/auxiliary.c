// SPDX-License-Identifier: GPL-3.0-or-later
// Grains, bonds and rows of the protocol are compacted in place. Grains that stay keep
// their order; a bond with one that goes is dropped, and so are the force and the
// liquid of a grain that goes. A place is read before it is written: new numbers are
// never above the old. Without kinds in the packing there is nothing to drop, and the
// arrays are left as they are; memory is not given back.
#include "auxiliary.h"

#include "basics/memory.h"

#include <stdlib.h>

// New numbers of the grains that stay, -1 for the others. Returns how many stay.
static int number_grains(const struct packing *packing, int32_t *number)
{
    int n = 0;
    for (int i = 0; i < packing->n_particle; i++)
        number[i] = is_auxiliary(packing, i) ? -1 : n++;
    return n;
}

static void drop_bonds(struct packing *packing, const int32_t *number)
{
    int n = 0;
    for (int b = 0; b < packing->n_bond; b++) {
        const int32_t first = number[packing->bond[b][0]];
        const int32_t second = number[packing->bond[b][1]];
        if (first < 0 || second < 0) continue;
        packing->bond[n][0] = first;
        packing->bond[n++][1] = second;
    }
    packing->n_bond = n;
}

void drop_auxiliary(struct packing *packing, struct protocol *protocol)
{
    if (!packing->kind) return;
    const int before = packing->n_particle;
    int32_t *number = NEW_ARRAY(int32_t, before);
    const int n = number_grains(packing, number);
    for (int i = 0; i < before; i++) {
        if (number[i] < 0) continue;
        packing->position[number[i]] = packing->position[i];
        packing->radius[number[i]] = packing->radius[i];
    }
    size_t to = 0; // never overtakes what is still read
    for (int k = 0; k < protocol->n_time; k++)
        for (int i = 0; i < before; i++) {
            if (number[i] < 0) continue;
            const size_t from = (size_t)k * (size_t)before + (size_t)i;
            if (protocol->liquid) protocol->liquid[to] = protocol->liquid[from];
            protocol->force[to++] = protocol->force[from];
        }
    drop_bonds(packing, number);
    packing->n_particle = n;
    free(packing->kind);
    packing->kind = NULL;
    free(number);
}
