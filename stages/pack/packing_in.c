// SPDX-License-Identifier: GPL-3.0-or-later
// An empty packing in a domain. Positions and radii are 0 until a method sets them.
#include "basics/memory.h"
#include "pack.h"

struct packing packing_in(const struct domain *domain, int n)
{
    struct packing packing = {.n_particle = n,
                              .position = NEW_ARRAY(struct vector, n),
                              .radius = NEW_ARRAY(double, n),
                              .lower = domain->lower,
                              .upper = domain->upper};
    packing.bond = allocate(0, sizeof *packing.bond);
    for (int axis = 0; axis < 3; axis++)
        packing.periodic[axis] = domain->periodic[axis];
    return packing;
}
