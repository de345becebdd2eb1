// SPDX-License-Identifier: GPL-3.0-or-later
// What pulls the grains of an equilibrium from outside.
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// What is gone has no load; where nothing holds the others, theirs is then balanced
// among themselves: if they may move far, where they are [rigid_motion.c].
void load_grains(struct equilibrium *e)
{
    const double unit = e->stiffness * e->length;
    const struct vector none = {0, 0, 0};
    struct vector *load = duplicate(e->force, (size_t)e->n, sizeof *load);
    for (int i = 0; i < e->n; i++)
        if (e->is_gone[i] || e->setup.fixed[i]) load[i] = none;
    e->taken_off = (struct net_load){none, none};
    if (e->setup.is_free && !e->large)
        e->taken_off = take_off_net_load(e->packing, e->is_gone, NULL, load);
    for (int i = 0; i < e->n; i++)
        e->load[i].shift = scale(1 / unit, load[i]);
    free(load);
}

// Of FORCE (n), of any unit, what would move as one grains that nothing holds and that
// have gone far.
static struct net_load take_off_there(const struct equilibrium *e, struct vector *force)
{
    struct vector *moved = displaced(e);
    const struct moving_grains there = {.displacement = moved};
    const struct net_load net =
        take_off_net_load(e->packing, e->is_gone, &there, force);
    free(moved);
    return net;
}

void measure_load(struct equilibrium *e)
{
    struct vector *load = NEW_ARRAY(struct vector, e->n);
    for (int i = 0; i < e->n; i++)
        load[i] = e->load[i].shift;
    if (e->setup.is_free && e->large) take_off_there(e, load);
    for (int i = 0; i < e->n; i++)
        e->largest_load = fmax(e->largest_load, norm(load[i]));
    free(load);
}

struct net_load equilibrium_load(const struct equilibrium *e, struct vector *force)
{
    for (int i = 0; i < e->n; i++)
        force[i] = scale(e->stiffness * e->length, e->load[i].shift);
    return e->setup.is_free && e->large ? take_off_there(e, force) : e->taken_off;
}
