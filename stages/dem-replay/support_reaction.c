// SPDX-License-Identifier: GPL-3.0-or-later
// The reaction of the supports on the grains, and its moment about the lower corner of
// the box:
//     force  = - sum over fixed grains of f_i - force on the wall,
//     moment = - sum over fixed grains of (x_i x f_i + m_i) - moment on the wall,
// with f_i, m_i everything that acts on a fixed grain: contacts, bonds and its own
// load, and x_i from the lower corner. A wall's moment is about its point, which is the
// lower corner. Fixed grains do not move, so x_i are places of the packing. From an
// equilibrium the reaction comes without the loads on fixed grains, which are added
// here.
#include "support_reaction.h"

#include "basics/memory.h"

#include <stdlib.h>

static void subtract_load(const struct packing *packing, int grain, struct vector force,
                          struct vector moment, struct net_load *sum)
{
    const struct vector from = subtract(packing->position[grain], packing->lower);
    sum->force = subtract(sum->force, force);
    sum->moment = subtract(sum->moment, add(cross(from, force), moment));
}

// Fixed grains do not move: the load on them is passed on to their support.
struct net_load reaction_of_dem(const struct packing *packing, const struct dem *dem,
                                const uint8_t *held, bool has_wall)
{
    struct vector *force = NEW_ARRAY(struct vector, packing->n_particle);
    struct vector *moment = NEW_ARRAY(struct vector, packing->n_particle);
    struct net_load sum = {0};
    dem_loads(dem, force, moment);
    for (int i = 0; i < packing->n_particle; i++)
        if (held[i]) subtract_load(packing, i, force[i], moment[i], &sum);
    if (has_wall) { // at the lower corner, as all moments here are about
        const struct dem_wall_state wall = dem_wall_state(dem, 0);
        sum.force = subtract(sum.force, wall.force);
        sum.moment = subtract(sum.moment, wall.moment);
    }
    free(force);
    free(moment);
    return sum;
}

struct net_load reaction_of_equilibrium(const struct packing *packing,
                                        const struct quasi_static *equilibrium,
                                        const uint8_t *held, const struct vector *force)
{
    struct net_load sum = {0};
    quasi_static_reaction(equilibrium, packing->lower, &sum.force, &sum.moment);
    for (int i = 0; i < packing->n_particle; i++)
        if (held[i])
            subtract_load(packing, i, force[i], (struct vector){0, 0, 0}, &sum);
    return sum;
}
