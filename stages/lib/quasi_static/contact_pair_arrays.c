// SPDX-License-Identifier: GPL-3.0-or-later
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <stdlib.h>

struct joint_setup joints_of(const struct equilibrium *e)
{
    return (struct joint_setup){.packing = e->packing,
                                .material = &e->setup.material,
                                .bond = &e->setup.bond,
                                .has_wall = e->setup.has_wall,
                                .unstressed = e->setup.unstressed,
                                .rolling = e->setup.rolling,
                                .length = e->length,
                                .stiffness = e->stiffness};
}

void free_room_for_joints(struct equilibrium *e)
{
    void *const of_joints[] = {e->strain,   e->more,       e->grown, e->tangent,
                               e->factored, e->resistance, e->unlike};
    for (size_t k = 0; k < sizeof of_joints / sizeof *of_joints; k++)
        free(of_joints[k]);
    corrections_free(e->corrections);
    stiffness_free(e->matrix);
}

void make_room_for_joints(struct equilibrium *e)
{
    free_room_for_joints(e);
    e->strain = allocate((size_t)e->n_joint, sizeof *e->strain);
    e->more = allocate((size_t)e->n_joint, sizeof *e->more);
    e->grown = allocate((size_t)e->n_joint, sizeof *e->grown);
    e->tangent = allocate((size_t)e->n_joint, sizeof *e->tangent);
    e->factored = NEW_ARRAY(struct factored, e->n_joint);
    e->resistance = NEW_ARRAY(struct resistance, e->n_joint);
    e->unlike = NEW_ARRAY(struct correction, e->n_joint);
    e->matrix = stiffness_new(e->n, e->setup.fixed, e->n_joint, e->joint);
    e->corrections = corrections_new(e->matrix, e->n_joint, e->joint, e->tangent);
}
