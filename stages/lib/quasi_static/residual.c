// SPDX-License-Identifier: GPL-3.0-or-later
// Unknowns u, displacements of the grains; given the load, the dashpots' forces so far
// and `previous`, the u that the step began from. In the order of the code
//     deformation = B u                                        of each pair
//     residual = load - damping (dashpot_force + grain_dashpot (u - previous))
//                - B^T response(B u)
// and 0 for grains that are fixed or detached. A residual is as large as the larger of
// its force and its moment; the largest of all grains is what the tolerance judges.
// Sums go by the pairs in their order, so they have the same digits on each call.
#include "quasi_static_internal.h"

#include <math.h>

void deform_pairs(const struct quasi_static *qs, const struct displacement *moved,
                  double (*deformation)[COMPONENTS])
{
    for (int j = 0; j < qs->n_pair; j++) {
        const int32_t *grain = qs->pair[j].grain;
        pair_deformation(&qs->pair[j], &moved[grain[0]],
                         grain[1] < 0 ? NULL : &moved[grain[1]], deformation[j]);
    }
}

void update_deformation(struct quasi_static *qs)
{
    deform_pairs(qs, qs->displacement, qs->deformation);
}

static struct displacement dashpot_load(const struct quasi_static *qs, int i)
{
    const struct displacement moved =
        displacement_between(&qs->previous[i], &qs->displacement[i]);
    struct displacement load = qs->dashpot_force[i];
    displacement_subtract(&load, displacement_scaled(-qs->grain_dashpot, moved));
    return displacement_scaled(qs->damping, load);
}

double largest_dashpot_load(const struct quasi_static *qs)
{
    double most = 0;
    for (int i = 0; i < qs->n; i++)
        most = fmax(most, displacement_size(dashpot_load(qs, i)));
    return most;
}

void update_residual(struct quasi_static *qs)
{
    for (int i = 0; i < qs->n; i++) {
        qs->residual[i] = qs->load[i];
        displacement_subtract(&qs->residual[i], dashpot_load(qs, i));
    }
    qs->kinematics->subtract_internal_loads(qs);
    for (int i = 0; i < qs->n; i++)
        if (qs->setup.fixed[i] || qs->is_detached[i]) qs->residual[i] = no_displacement;
}

double largest_residual(const struct quasi_static *qs)
{
    double most = 0;
    for (int i = 0; i < qs->n; i++)
        most = fmax(most, displacement_size(qs->residual[i]));
    return most;
}

int grain_of_largest_residual(const struct quasi_static *qs)
{
    int worst = 0;
    for (int i = 1; i < qs->n; i++)
        if (displacement_size(qs->residual[i]) > displacement_size(qs->residual[worst]))
            worst = i;
    return worst;
}
