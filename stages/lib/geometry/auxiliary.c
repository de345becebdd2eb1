// SPDX-License-Identifier: GPL-3.0-or-later
// Grains that stay keep their order; a bond with one that goes is dropped.
#include "geometry/auxiliary.h"

#include "basics/memory.h"

#include <stdlib.h>
#include <string.h>

// New numbers of the grains that stay, -1 for the others. Returns how many stay.
static int number_grains(const struct packing *packing, int32_t *number)
{
    int n = 0;
    for (int i = 0; i < packing->n_particle; i++)
        number[i] = is_auxiliary(packing, i) ? -1 : n++;
    return n;
}

static void copy_bonds(const struct packing *from, const int32_t *number,
                       struct packing *to)
{
    to->n_bond = 0;
    for (int b = 0; b < from->n_bond; b++) {
        const int32_t first = number[from->bond[b][0]];
        const int32_t second = number[from->bond[b][1]];
        if (first < 0 || second < 0) continue;
        if (from->bond_strength) to->bond_strength[to->n_bond] = from->bond_strength[b];
        to->bond[to->n_bond][0] = first;
        to->bond[to->n_bond++][1] = second;
    }
}

struct packing without_auxiliary(const struct packing *packing)
{
    struct packing kept = *packing;
    int32_t *number = NEW_ARRAY(int32_t, packing->n_particle);
    kept.n_particle = number_grains(packing, number);
    kept.kind = NULL;
    kept.position = NEW_ARRAY(struct vector, kept.n_particle);
    kept.radius = NEW_ARRAY(double, kept.n_particle);
    kept.bond = allocate((size_t)packing->n_bond, sizeof *kept.bond);
    if (packing->bond_strength) kept.bond_strength = NEW_ARRAY(double, packing->n_bond);
    copy_without_auxiliary(packing, packing->position, sizeof *kept.position,
                           kept.position);
    copy_without_auxiliary(packing, packing->radius, sizeof *kept.radius, kept.radius);
    copy_bonds(packing, number, &kept);
    free(number);
    return kept;
}

void copy_without_auxiliary(const struct packing *packing, const void *from,
                            size_t size, void *to)
{
    const char *value = from;
    char *place = to;
    if (!packing->kind) memcpy(to, from, (size_t)packing->n_particle * size);
    for (int i = 0; packing->kind && i < packing->n_particle; i++, value += size) {
        if (is_auxiliary(packing, i)) continue;
        memcpy(place, value, size);
        place += size;
    }
}
