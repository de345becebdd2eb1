// SPDX-License-Identifier: GPL-3.0-or-later
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

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
