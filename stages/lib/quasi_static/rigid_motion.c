// SPDX-License-Identifier: GPL-3.0-or-later
// A body that nothing holds, under forces that keep their directions. Its net force and
// moment are balanced by one acceleration and one angular acceleration of all grains,
// times their masses, on the geometry as it is. So there is an equilibrium for each
// position and orientation; the one meant keeps the mean position and orientation of
// the grains, by masses m:
//     sum m u = 0,  sum m X x u + I w = 0,
// X where they began, about their centre, u translation, w rotation and I the inertia
// of a grain: the rotation that fits all displacements best is none.
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <stdlib.h>

struct vector *displacements_in_metres(const struct quasi_static *qs)
{
    struct vector *displacement = NEW_ARRAY(struct vector, qs->n);
    for (int i = 0; i < qs->n; i++)
        displacement[i] = scale(qs->length, qs->displacement[i].translation);
    return displacement;
}

void project_rigid_load(struct quasi_static *qs)
{
    struct vector *moved = displacements_in_metres(qs);
    const struct whole there = whole_of(qs->packing, qs->is_detached, moved);
    const double unit = there.length / qs->length;
    struct vector force = {0, 0, 0}, moment = {0, 0, 0};
    for (int i = 0; i < qs->n; i++) {
        if (qs->is_detached[i]) continue;
        const struct displacement *left = &qs->residual[i];
        const struct vector arm = scale(unit, whole_place(&there, i));
        force = add(force, left->translation);
        moment = add(moment, add(cross(arm, left->translation), left->rotation));
    }
    if (there.mass > 0) {
        const struct vector push = scale(1 / there.mass, force);
        const struct vector turn = whole_turn(&there, scale(1 / unit, moment));
        for (int i = 0; i < qs->n; i++) {
            const struct vector each = add(push, cross(turn, whole_place(&there, i)));
            qs->residual[i].translation = subtract(qs->residual[i].translation,
                                                   scale(whole_mass(&there, i), each));
        }
    }
    free(moved);
}

// The inertia of a grain, a sphere of MASS, about its own centre: with it, a straight
// row has an orientation about its own axis.
static double own_inertia(const struct whole *whole, int i, double mass)
{
    const double radius = whole->packing->radius[i] / whole->length;
    return 0.4 * mass * radius * radius;
}

// How the mean orientation changes with a rotation of the body where it is now:
// sum m ((X . x) 1 - (X x^T + x X^T) / 2) + I. What is not symmetric is left out.
static void mix_inertia(struct whole *there, const struct whole *start)
{
    for (int axis = 0; axis < 3; axis++)
        there->inertia[axis] = (struct vector){0, 0, 0};
    for (int i = 0; i < there->packing->n_particle; i++) {
        const double mass = whole_mass(there, i), own = own_inertia(there, i, mass);
        const struct vector x = whole_place(start, i), r = whole_place(there, i);
        for (int axis = 0; axis < 3; axis++) {
            struct vector part = add(scale(-0.5 * mass * component(x, axis), r),
                                     scale(-0.5 * mass * component(r, axis), x));
            set_component(&part, axis, component(part, axis) + mass * dot(x, r) + own);
            there->inertia[axis] = add(there->inertia[axis], part);
        }
    }
}

// The translation and rotation of THERE that have the mean of STEP.
static struct displacement mean_motion(const struct whole *there,
                                       const struct whole *start, double unit,
                                       const struct displacement *step)
{
    struct vector shift = {0, 0, 0}, moment = {0, 0, 0};
    for (int i = 0; i < there->packing->n_particle; i++) {
        const double mass = whole_mass(there, i);
        const struct vector part = scale(mass, step[i].translation);
        const struct vector own = scale(own_inertia(there, i, mass), step[i].rotation);
        shift = add(shift, part);
        moment = add(moment, scale(1 / unit, cross(whole_place(start, i), part)));
        moment = add(moment, own);
    }
    return (struct displacement){scale(1 / there->mass, shift),
                                 whole_turn(there, moment)};
}

// Takes off STEP what changes the mean position and orientation of START.
static void remove_mean_motion(const struct quasi_static *qs, const struct whole *start,
                               struct whole *there, struct displacement *step)
{
    enum { PASSES = 2 }; // for what is not symmetric
    const double unit = there->length / qs->length;
    mix_inertia(there, start);
    for (int pass = 0; pass < PASSES && there->mass > 0; pass++) {
        const struct displacement mean = mean_motion(there, start, unit, step);
        for (int i = 0; i < qs->n; i++) {
            if (qs->is_detached[i]) continue;
            const struct vector arm = scale(unit, whole_place(there, i));
            const struct vector way = add(mean.translation, cross(mean.rotation, arm));
            displacement_subtract(&step[i], (struct displacement){way, mean.rotation});
        }
    }
}

void remove_rigid_motion(const struct quasi_static *qs, struct displacement *step)
{
    struct vector *moved = displacements_in_metres(qs);
    const struct whole start = whole_of(qs->packing, qs->is_detached, NULL);
    struct whole there = whole_of(qs->packing, qs->is_detached, moved);
    remove_mean_motion(qs, &start, &there, step);
    free(moved);
}

void remove_small_rigid_motion(const struct quasi_static *qs,
                               struct displacement *moved)
{
    const struct whole start = whole_of(qs->packing, qs->is_detached, NULL);
    struct whole there = start;
    remove_mean_motion(qs, &start, &there, moved);
}

void remove_momentum(const struct quasi_static *qs, struct displacement *mode)
{
    struct vector *moved = displacements_in_metres(qs);
    const struct whole start = whole_of(qs->packing, qs->is_detached, moved);
    struct whole there = start;
    remove_mean_motion(qs, &start, &there, mode);
    free(moved);
}
