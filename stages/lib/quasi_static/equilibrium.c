// SPDX-License-Identifier: GPL-3.0-or-later
#include "equilibrium_state.h"

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

static void free_room_for_joints(struct equilibrium *e)
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

// ---- bonds --------------------------------------------------------------------------

static void record_crack(struct equilibrium *e, struct joint *joint, int mode)
{
    const int i = joint->grain[0];
    const struct vector from =
        add(e->trial[i].shift, scale(joint->arm[0], joint->axis[0]));
    GROW_ARRAY(e->crack, e->n_crack, e->crack_capacity);
    e->crack[e->n_crack++] = (struct dem_crack){
        .bond = joint->bond,
        .mode = (uint8_t)mode,
        .cycle = e->iterations,
        .position = add(e->packing->position[i], scale(e->length, from))};
    joint_break(joint, e->strain[joint - e->joint]);
}

static struct overload overload_of(const struct equilibrium *e, int j)
{
    const struct joint *joint = &e->joint[j];
    const double unit = e->setup.bond.kind == DEM_CONTACT_BOND // of strengths
                            ? e->stiffness * e->length
                            : e->stiffness / e->length;
    const double share =
        e->setup.relative_strength ? e->setup.relative_strength[joint->bond] : 1;
    return joint_overload(joint, e->strain[j],
                          share * e->setup.bond.normal_strength / unit,
                          share * e->setup.bond.shear_strength / unit);
}

// The first of those that are as much overloaded as any, as far as rounding leaves
// open.
bool break_one(struct equilibrium *e)
{
    const double equal = 1 - 1e-8;
    double *larger = NEW_ARRAY(double, e->n_joint), most = 0;
    for (int j = 0; j < e->n_joint; j++) {
        if (!e->joint[j].is_bonded || e->joint[j].is_gone) continue;
        const struct overload overload = overload_of(e, j);
        larger[j] = fmax(overload.normal, overload.shear);
        most = fmax(most, larger[j]);
    }
    int worst = 0;
    while (most >= strong && larger[worst] < equal * most)
        worst++;
    free(larger);
    if (!(most >= strong)) return false;
    const struct overload overload = overload_of(e, worst);
    record_crack(e, &e->joint[worst],
                 overload.normal >= overload.shear ? DEM_CRACK_NORMAL
                                                   : DEM_CRACK_SHEAR);
    return true;
}

void find_fragments(struct equilibrium *e)
{
    fragments_begin(&e->fragments);
    for (int j = 0; j < e->n_joint; j++)
        if (e->joint[j].is_bonded && !e->joint[j].is_gone)
            fragments_join(&e->fragments, e->joint[j].grain[0], e->joint[j].grain[1]);
    fragments_end(&e->fragments, e->setup.fixed, e->is_gone);
}

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
