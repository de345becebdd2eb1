// SPDX-License-Identifier: GPL-3.0-or-later
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

// ---- begin and end ------------------------------------------------------------------

static void find_units(struct equilibrium *e)
{
    const struct packing *packing = e->packing;
    for (int i = 0; i < packing->n_particle; i++)
        e->length += packing->radius[i] / packing->n_particle;
    double radius = 0; // of the thickest bond
    for (int b = 0; b < packing->n_bond; b++)
        radius = fmax(radius, fmin(packing->radius[packing->bond[b][0]],
                                   packing->radius[packing->bond[b][1]]));
    radius *= e->setup.bond.radius_fraction;
    const double glue = e->setup.bond.kind == DEM_CONTACT_BOND
                            ? 0
                            : e->setup.bond.normal_stiffness * M_PI * radius * radius;
    e->stiffness = fmax(glue, e->setup.material.normal_stiffness);
}

// Much softer than anything that resists: it moves what nothing holds, and nothing
// else.
static double softness(const struct equilibrium *e)
{
    double least = 1;
    for (int j = 0; j < e->n_joint; j++) {
        const double each[] = {e->joint[j].bond_stiffness[STRAIN_ALONG],
                               e->joint[j].contact_along};
        for (int k = 0; k < 2; k++)
            if (each[k] > 0) least = fmin(least, each[k]);
    }
    return 1e-9 * least;
}

enum status equilibrium_new(struct equilibrium **result,
                            const struct equilibrium_setup *setup,
                            struct reason *reason)
{
    struct equilibrium *e = NEW_ARRAY(struct equilibrium, 1);
    const int n = setup->packing->n_particle;
    *result = NULL;
    e->packing = setup->packing;
    e->setup = *setup;
    e->n = n;
    find_units(e);
    if (n > 0 && !(e->stiffness > 0)) {
        free(e);
        return refuse(reason, STATUS_BAD_DATA,
                      "neither contacts nor bonds resist: there is no equilibrium");
    }
    const struct joint_setup joints = joints_of(e);
    e->joint = make_joints(&joints, &e->n_joint);
    struct displacement **const of_grains[] = {
        &e->trial, &e->load, &e->dashpots, &e->left, &e->step, &e->before, &e->rest};
    for (size_t k = 0; k < sizeof of_grains / sizeof *of_grains; k++)
        *of_grains[k] = NEW_ARRAY(struct displacement, n);
    e->is_gone = NEW_ARRAY(bool, n);
    e->fragments = fragments_new(n);
    e->soft[0] = e->soft[1] = softness(e);
    make_room_for_joints(e);
    e->may_leave = !setup->large_displacements;
    e->kind = e->may_leave ? &small_displacements : &large_displacements;
    if (setup->large_displacements) e->large = large_new(e);
    *result = e;
    return STATUS_OK;
}

void equilibrium_free(struct equilibrium *e)
{
    if (!e) return;
    fragments_free(&e->fragments);
    free_room_for_joints(e);
    large_free(e->large);
    void *const owned[] = {e->joint, e->trial,  e->load, e->dashpots, e->left,
                           e->step,  e->before, e->rest, e->is_gone,  e->crack};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(e);
}

// ---- one load -----------------------------------------------------------------------

static enum status refuse_numbers(int grain, struct reason *reason)
{
    return refuse(reason, STATUS_NOT_CONVERGED,
                  "no equilibrium of grain %d that numbers hold: stiffnesses lie too "
                  "far apart (engine=explicit solves no equations)",
                  grain);
}

static enum status check_small(const struct equilibrium *e, struct reason *reason)
{
    for (int i = 0; i < e->n; i++) {
        if (e->is_gone[i] || size_of(e->trial[i]) <= furthest) continue;
        if (isnan(size_of(e->trial[i]))) return refuse_numbers(i, reason);
        if (e->large) continue;
        return refuse(reason, STATUS_NOT_CONVERGED,
                      "grain %d moves %.3g mean radii: displacements are not small, "
                      "and equilibrium is a matter of dynamics "
                      "(quasi_static.large_displacements=true, "
                      "engine=explicit, or stiffer bonds)",
                      i, size_of(e->trial[i]));
    }
    for (int j = 0; j < e->n_joint; j++) {
        const double *load = e->resistance[j].load;
        if (!e->joint[j].is_gone && isnan(load[0] + load[1] + load[2]))
            return refuse_numbers(e->joint[j].grain[0], reason);
    }
    return STATUS_OK;
}

enum status equilibrium_find(struct equilibrium *e, const struct vector *force,
                             struct reason *reason)
{
    e->force = force;
    e->n_load++;
    load_grains(e);
    measure_load(e);
    if (e->large) e->large->tried = 0;
    e->is_restless = false;
    do {
        const enum status status = e->kind->balance(e, reason);
        if (status) return status;
    } while (break_one(e));
    return check_small(e, reason);
}
