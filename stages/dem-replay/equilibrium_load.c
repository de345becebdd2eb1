// SPDX-License-Identifier: GPL-3.0-or-later
// What pulls the grains of an equilibrium from outside.
#include "equilibrium_state.h"

#include "basics/memory.h"

#include <stdlib.h>

// What is gone has no load; where nothing holds the others, theirs is then balanced
// among themselves.
void load_grains(struct equilibrium *e)
{
    const double unit = e->stiffness * e->length;
    struct vector *force = NEW_ARRAY(struct vector, e->n);
    for (int i = 0; i < e->n; i++)
        if (!e->is_gone[i] && !e->setup.fixed[i]) force[i] = e->force[i];
    if (e->setup.is_free)
        e->taken_off = take_off_net_load(e->packing, e->is_gone, NULL, force);
    for (int i = 0; i < e->n; i++)
        e->load[i].shift = scale(1 / unit, force[i]);
    free(force);
}

struct net_load equilibrium_load(const struct equilibrium *e, struct vector *force)
{
    for (int i = 0; i < e->n; i++)
        force[i] = scale(e->stiffness * e->length, e->load[i].shift);
    return e->taken_off;
}
