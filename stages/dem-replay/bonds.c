// SPDX-License-Identifier: GPL-3.0-or-later
// Bonds by distance: pairs of grains whose gap is at most a part of the sum of their
// radii. Grains that touch are those with a gap of rounding. Pairs come sorted and with
// the lower grain first, for any number of threads, so the numbers of bonds, and what
// is drawn for them, repeat.
#include "bonds.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <stdlib.h>

static const double ROUNDING = 1e-6; // of the sum of the radii, as pack.touching_gap

void bond_grains(struct packing *packing, enum bonds_by by, double gap)
{
    if (by == BONDS_BY_PACKING) return;
    packing->n_bond = 0;
    free(packing->bond_strength);
    packing->bond_strength = NULL;
    if (by == BONDS_BY_NONE) return;
    free(packing->bond);
    packing->bond = neighbour_pairs(packing, by == BONDS_BY_DISTANCE ? gap : ROUNDING,
                                    &packing->n_bond);
}
