// SPDX-License-Identifier: GPL-3.0-or-later
// What pulls the grains of an equilibrium from outside.
#include "equilibrium_state.h"

#include "basics/memory.h"

#include <stdlib.h>

// What is gone has no load; where nothing holds the others, theirs is then balanced
// among themselves.
struct net_load loads_of(const struct equilibrium *e, const struct vector *from,
                         struct vector *load)
{
    const double unit = e->stiffness * e->length;
    struct net_load taken_off = {{0, 0, 0}, {0, 0, 0}};
    for (int i = 0; i < e->n; i++)
        load[i] =
            e->is_gone[i] || e->setup.fixed[i] ? (struct vector){0, 0, 0} : from[i];
    if (e->setup.is_free)
        taken_off = take_off_net_load(e->packing, e->is_gone, NULL, load);
    for (int i = 0; i < e->n; i++)
        load[i] = scale(1 / unit, load[i]);
    return taken_off;
}

void load_grains(struct equilibrium *e)
{
    struct vector *load = NEW_ARRAY(struct vector, e->n);
    e->taken_off = loads_of(e, e->force, load);
    for (int i = 0; i < e->n; i++)
        e->load[i].shift = load[i];
    free(load);
}

struct net_load equilibrium_load(const struct equilibrium *e, struct vector *force)
{
    realise(e->foresight);
    for (int i = 0; i < e->n; i++)
        force[i] = scale(e->stiffness * e->length, e->load[i].shift);
    return e->taken_off;
}
