// SPDX-License-Identifier: GPL-3.0-or-later
// A slab out of the middle of a thicker packing: grains with their centres between two
// heights stay, and the box ends on their surfaces. Walls order the grains beside them,
// and what then cracks follows the crystals; a cut leaves a rough floor and top.
//
//     stays:  lower <= z <= upper  of the centre, each end only where it is given,
//     box:    from the lowest to the highest surface of grains that stay; a wall
//             stays where nothing is cut.
// Grains are compacted in place, in their order. Bonds are dropped, since their grains
// have other numbers then; they are made anew from contacts (main.c).
#include "pack.h"

#include <math.h>

enum status cut_slab(double lower, double upper, struct domain *domain,
                     struct packing *packing, struct reason *reason)
{
    if (isnan(lower) && isnan(upper)) return STATUS_OK;
    if (domain->shape != DOMAIN_BOX || domain->cut != CUT_NONE)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.slab: needs pack.domain.shape = box, and nothing cut out");
    if (!(isnan(lower) || isnan(upper)) && !(lower < upper))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.slab.upper: must be above %g, of slab.lower, got %g", lower,
                      upper);
    double low = INFINITY, high = -INFINITY;
    int n = 0;
    for (int i = 0; i < packing->n_particle; i++) {
        const struct vector at = packing->position[i];
        const double radius = packing->radius[i];
        if (at.z < lower || at.z > upper) continue;
        packing->position[n] = at;
        if (packing->kind) packing->kind[n] = packing->kind[i];
        packing->radius[n++] = radius;
        low = fmin(low, at.z - radius);
        high = fmax(high, at.z + radius);
    }
    if (n == 0)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.slab: there is no grain between slab.lower and slab.upper");
    packing->n_particle = n;
    packing->n_bond = 0;
    const bool has_walls = !domain->periodic[2];
    if (!(has_walls && isnan(lower))) packing->lower.z = domain->lower.z = low;
    if (!(has_walls && isnan(upper))) packing->upper.z = domain->upper.z = high;
    packing->periodic[2] = domain->periodic[2] = false;
    return STATUS_OK;
}
