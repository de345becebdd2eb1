// SPDX-License-Identifier: GPL-3.0-or-later
// Porosity of the box, by ratios of lengths, so that no cube of a length underflows.
//     porosity = 1 - sum of (4/3) pi (r / x) (r / y) (r / z),   x, y, z the edges.
#include "pack.h"

double packing_porosity(const struct packing *packing)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    double solid = 0;
    for (int i = 0; i < packing->n_particle; i++)
        solid += 4 * M_PI / 3 * packing->radius[i] / edge.x * packing->radius[i] /
                 edge.y * packing->radius[i] / edge.z;
    return 1 - solid;
}
