// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/packing.h"

#include <stdlib.h>

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
