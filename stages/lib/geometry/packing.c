// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/packing.h"

#include <stdlib.h>

void packing_free(struct packing *packing)
{
    free(packing->position);
    free(packing->radius);
    free(packing->bond);
    *packing = (struct packing){0};
}
