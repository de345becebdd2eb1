// SPDX-License-Identifier: GPL-3.0-or-later
// Stokes' drag on grains much smaller than their pore. For each grain, over the
// throats that it is a corner of,
//     u = 2 sum of flux step / sum of volume    (twice the mean velocity around it)
//     more = sqrt(|F|^2 + (6 pi mu R u)^2) - |F|   along u,   mu = 1,
// where F is what C 14 and 18 give it. What it gets more is taken from the other
// corners of these throats, by their surfaces: the sum of all forces stays.
#include "small_grains.h"

#include "basics/memory.h"

#include <stdlib.h>

// Sums over the throats that a grain is a corner of.
struct neighbourhood {
    struct vector moment; // flux times step, for a viscosity of 1
    double volume;        // of fluid
    double surface;       // of the other corners
    struct vector more;   // force that the grain gets, and they lose
};

static struct neighbourhood *find_neighbourhoods(const struct grains *grains,
                                                 const struct cells *cells,
                                                 const struct throats *throats,
                                                 const struct pressures *pressures)
{
    struct neighbourhood *around = NEW_ARRAY(struct neighbourhood, grains->n_base);
    for (int t = 0; t < throats->n; t++) {
        const struct throat *throat = &throats->throat[t];
        const double drop = pressure_drop(pressures, grains, cells, throat);
        const struct vector moment =
            scale(throat->conductance * drop, throat_step(grains, cells, throat));
        const double surface =
            throat->surface[0] + throat->surface[1] + throat->surface[2];
        for (int k = 0; k < 3; k++) {
            if (throat->corner[k] < 0) continue;
            struct neighbourhood *here = &around[throat->corner[k]];
            here->moment = add(here->moment, moment);
            here->volume += throat->volume;
            here->surface += surface - throat->surface[k];
        }
    }
    return around;
}

// The root of the sum of squares of both drags, less the force there is.
static struct vector missing_drag(const struct neighbourhood *around, double radius,
                                  struct vector force)
{
    const double moment = norm(around->moment), there = norm(force);
    if (!(moment > 0 && around->volume > 0 && around->surface > 0))
        return (struct vector){0};
    const double stokes = 6 * M_PI * radius * 2 * moment / around->volume;
    return scale((hypot(there, stokes) - there) / moment, around->moment);
}

void add_stokes_drag(const struct grains *grains, const struct cells *cells,
                     const struct throats *throats, const struct pressures *pressures,
                     struct forces *forces)
{
    struct neighbourhood *around =
        find_neighbourhoods(grains, cells, throats, pressures);
    for (int i = 0; i < grains->n_base; i++)
        around[i].more = missing_drag(&around[i], grains->radius[i],
                                      add(forces->viscous[i], forces->pressure[i]));
    for (int i = 0; i < grains->n_base; i++)
        forces->viscous[i] = add(forces->viscous[i], around[i].more);
    for (int t = 0; t < throats->n; t++) {
        const struct throat *throat = &throats->throat[t];
        for (int k = 0; k < 3; k++) {
            if (throat->corner[k] < 0) continue;
            const struct neighbourhood *here = &around[throat->corner[k]];
            for (int m = 0; m < 3 && here->surface > 0; m++) {
                const int32_t host = throat->corner[m];
                if (m == k) continue;
                struct vector *viscous = host < 0 ? &forces->wall_viscous[-1 - host]
                                                  : &forces->viscous[host];
                *viscous = add(*viscous,
                               scale(-throat->surface[m] / here->surface, here->more));
            }
        }
    }
    free(around);
}
