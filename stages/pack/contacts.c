// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/neighbours.h"
#include "pack.h"

#include <stdlib.h>

void bond_touching(struct packing *packing, double gap)
{
    free(packing->bond);
    packing->bond = neighbour_pairs(packing, gap, &packing->n_bond);
}

double packing_porosity(const struct packing *packing)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    double solid = 0;
    for (int i = 0; i < packing->n_particle; i++)
        solid += 4 * M_PI / 3 * packing->radius[i] / edge.x * packing->radius[i] /
                 edge.y * packing->radius[i] / edge.z;
    return 1 - solid;
}

void packing_contacts(const struct packing *packing, double gap, double *max_overlap,
                      double *coordination)
{
    int count;
    int32_t(*pair)[2] = neighbour_pairs(packing, gap, &count);
    *max_overlap = 0;
    for (int k = 0; k < count; k++) {
        const double ri = packing->radius[pair[k][0]], rj = packing->radius[pair[k][1]];
        const double apart = norm(nearest_image(packing, pair[k][0], pair[k][1]));
        *max_overlap = fmax(*max_overlap, (ri + rj - apart) / fmin(ri, rj));
    }
    *coordination = packing->n_particle ? 2.0 * count / packing->n_particle : 0;
    free(pair);
}
