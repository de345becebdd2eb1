// SPDX-License-Identifier: GPL-3.0-or-later
// Viscous stress of the fluid, averaged over each pore. By Gauss' theorem, and because
// the fluid sticks to the grains,
//     stress = mu 1/V integral of (n u + u n) over the facets
//            = 1/V sum over facets of 2 flux n n   (mu = 1),
// with the velocity u taken along the facet's normal n. Fluid that enters through a
// wall passes a facet with the wall's normal. Flux in equals flux out, so the trace
// vanishes.
#include "pore_stress.h"

#include "basics/memory.h"

#include <stdlib.h>

// Adds the term of a FLUX out of the pore through a facet with unit normal N.
static void add_outflow(double sum[6], double flux, struct vector n)
{
    sum[0] += 2 * flux * n.x * n.x;
    sum[1] += 2 * flux * n.y * n.y;
    sum[2] += 2 * flux * n.z * n.z;
    sum[3] += 2 * flux * n.y * n.z;
    sum[4] += 2 * flux * n.z * n.x;
    sum[5] += 2 * flux * n.x * n.y;
}

static void add_throats(const struct grains *grains, const struct cells *cells,
                        const struct throats *throats,
                        const struct pressures *pressures, struct pore_stress *stress,
                        double *outflow)
{
    for (int t = 0; t < throats->n; t++) {
        const struct throat *throat = &throats->throat[t];
        const double flux =
            throat->conductance > 0
                ? throat->conductance * pressure_drop(pressures, grains, cells, throat)
                : 0;
        const double area = norm(throat->area);
        for (int end = 0; end < 2; end++) {
            const int pore = cells->cell[throat->cell[end]].pore;
            const double out = end == 0 ? flux : -flux;
            stress->volume[pore] += 0.5 * throat->volume;
            outflow[pore] += out;
            if (area > 0)
                add_outflow(stress->viscous[pore], out, scale(1 / area, throat->area));
        }
    }
}

struct pore_stress find_pore_stress(const struct grains *grains,
                                    const struct cells *cells,
                                    const struct throats *throats,
                                    const struct conditions *conditions,
                                    const struct pressures *pressures)
{
    const int n = cells->n_pore;
    struct pore_stress stress = {.volume = NEW_ARRAY(double, n),
                                 .viscous =
                                     allocate((size_t)n, sizeof *stress.viscous)};
    double *outflow = NEW_ARRAY(double, n), whole = 0;
    uint8_t *walls = walls_of_pores(cells);
    add_throats(grains, cells, throats, pressures, &stress, outflow);
    for (int i = 0; i < n; i++) {
        const int wall = feeding_wall(conditions, walls[i]);
        if (wall >= 0) add_outflow(stress.viscous[i], -outflow[i], wall_normal(wall));
        whole += stress.volume[i];
        for (int k = 0; k < 6; k++) {
            stress.mean_viscous[k] += stress.viscous[i][k];
            stress.viscous[i][k] /=
                fabs(stress.volume[i]) > 0 ? stress.volume[i] : INFINITY;
        }
    }
    for (int k = 0; k < 6; k++)
        stress.mean_viscous[k] /= fabs(whole) > 0 ? whole : INFINITY;
    free(outflow);
    free(walls);
    return stress;
}

void pore_stress_free(struct pore_stress *stress)
{
    free(stress->volume);
    free(stress->viscous);
    *stress = (struct pore_stress){0};
}
