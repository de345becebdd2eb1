// SPDX-License-Identifier: GPL-3.0-or-later
// The load: forces from outside on grains that are neither fixed nor detached. Where
// nothing holds the body, net force and moment are taken off: of small displacements
// here, once; of large ones where the grains are [rigid_motion.c].
//     load = (force - what is taken off) / (stiffness length),
// and the largest so far is the scale of the residual.
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

void apply_external_load(struct quasi_static *qs)
{
    const double unit = qs->stiffness * qs->length;
    const struct vector none = {0, 0, 0};
    struct vector *load = duplicate(qs->force, (size_t)qs->n, sizeof *load);
    for (int i = 0; i < qs->n; i++)
        if (qs->is_detached[i] || qs->setup.fixed[i]) load[i] = none;
    qs->taken_off = (struct net_load){none, none};
    if (qs->setup.is_free && !qs->large)
        qs->taken_off = take_off_net_load(qs->packing, qs->is_detached, NULL, load);
    for (int i = 0; i < qs->n; i++)
        qs->load[i].translation = scale(1 / unit, load[i]);
    free(load);
}

// Takes net force and moment off FORCE (n), of any unit, where the grains are now.
static struct net_load take_off_there(const struct quasi_static *qs,
                                      struct vector *force)
{
    struct vector *moved = displacements_in_metres(qs);
    const struct moving_grains there = {.displacement = moved};
    const struct net_load net =
        take_off_net_load(qs->packing, qs->is_detached, &there, force);
    free(moved);
    return net;
}

void update_load_scale(struct quasi_static *qs)
{
    struct vector *load = NEW_ARRAY(struct vector, qs->n);
    for (int i = 0; i < qs->n; i++)
        load[i] = qs->load[i].translation;
    if (qs->setup.is_free && qs->large) take_off_there(qs, load);
    for (int i = 0; i < qs->n; i++)
        qs->largest_load = fmax(qs->largest_load, norm(load[i]));
    free(load);
}

struct net_load quasi_static_load(const struct quasi_static *qs, struct vector *force)
{
    for (int i = 0; i < qs->n; i++)
        force[i] = scale(qs->stiffness * qs->length, qs->load[i].translation);
    return qs->setup.is_free && qs->large ? take_off_there(qs, force) : qs->taken_off;
}
