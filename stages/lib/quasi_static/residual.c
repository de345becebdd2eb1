// SPDX-License-Identifier: GPL-3.0-or-later
#include "quasi_static_internal.h"

#include <math.h>

// The strains that joints, as they lie, have when grains have MOVED (n).
void strain_joints(const struct equilibrium *e, const struct displacement *moved,
                   double (*strain)[STRAINS])
{
    for (int j = 0; j < e->n_joint; j++) {
        const int32_t *grain = e->joint[j].grain;
        joint_strains(&e->joint[j], &moved[grain[0]],
                      grain[1] < 0 ? NULL : &moved[grain[1]], strain[j]);
    }
}

void strain_trial(struct equilibrium *e)
{
    strain_joints(e, e->trial, e->strain);
}

// What is left of the load at the trial.
void resist(struct equilibrium *e)
{
    for (int i = 0; i < e->n; i++) {
        e->left[i] = e->load[i];
        pull(&e->left[i], scaled(e->damping, e->dashpots[i]));
    }
    e->kind->resist(e);
    for (int i = 0; i < e->n; i++)
        if (e->setup.fixed[i] || e->is_gone[i]) e->left[i] = no_displacement;
}

double largest_left(const struct equilibrium *e)
{
    double most = 0;
    for (int i = 0; i < e->n; i++)
        most = fmax(most, size_of(e->left[i]));
    return most;
}

int least_balanced(const struct equilibrium *e)
{
    int worst = 0;
    for (int i = 1; i < e->n; i++)
        if (size_of(e->left[i]) > size_of(e->left[worst])) worst = i;
    return worst;
}
