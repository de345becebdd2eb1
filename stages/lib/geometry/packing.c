// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/packing.h"

#include <stdlib.h>

bool is_periodic(const struct packing *packing)
{
    return packing->periodic[0] || packing->periodic[1] || packing->periodic[2];
}

double wall_position(const struct packing *packing, int wall)
{
    return component(wall % 2 ? packing->upper : packing->lower, wall / 2);
}

void packing_free(struct packing *packing)
{
    free(packing->position);
    free(packing->radius);
    free(packing->bond);
    *packing = (struct packing){0};
}
