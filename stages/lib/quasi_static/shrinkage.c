// SPDX-License-Identifier: GPL-3.0-or-later
// Drying shrinkage, as of the engine of cycles [dem/shrinkage.c]: grains i and j of
// radii R at the start become smaller by the strains e, at the distance l at the start,
//     shortening   = R_i e_i + R_j e_j,
//     overlap     -= the growth of it,
//     free_stretch -= that times l / (R_i + R_j)     [contact bond: that alone].
// So a free body shrinks without any force, and between grains held apart a bond of
// e = e_i = e_j carries k^n A l e. Arms, areas and moments stay those of the start:
// they change by terms of second order in e.
//
// The scale of residuals is the largest load; without forces from outside it is what a
// bond (or a contact that is closed) would carry between grains held apart.
#include "large/large_state.h"
#include "quasi_static_internal.h"

#include <math.h>

// Mean radii by which the grains at PAIR become smaller, with STRAIN (n).
static double shortening(const struct quasi_static *qs, const struct contact_pair *pair,
                         const double *strain)
{
    double sum = 0;
    for (int end = 0; end < 2; end++)
        if (pair->grain[end] >= 0)
            sum += qs->packing->radius[pair->grain[end]] / qs->length *
                   strain[pair->grain[end]];
    return sum;
}

// By how much the free length of a bond at pair J shortens as its grains do.
static double bond_share(const struct quasi_static *qs, int j)
{
    const struct contact_pair *pair = &qs->pair[j];
    if (pair->is_point) return 1;
    const double *radius = qs->packing->radius;
    const double *arm = qs->large ? qs->large->start[j].arm : pair->arm;
    return (arm[0] + arm[1]) * qs->length /
           (radius[pair->grain[0]] + radius[pair->grain[1]]);
}

void shrink_new_pair(const struct quasi_static *qs, struct contact_pair *pair)
{
    if (qs->shrinkage) pair->overlap -= shortening(qs, pair, qs->shrinkage);
}

void quasi_static_shrink(struct quasi_static *qs, const double *strain)
{
    for (int j = 0; j < qs->n_pair; j++) {
        struct contact_pair *pair = &qs->pair[j];
        const double all = shortening(qs, pair, strain);
        const double more = all - shortening(qs, pair, qs->shrinkage);
        const double share = pair->bond >= 0 ? bond_share(qs, j) : 1;
        pair->overlap -= more;
        if (pair->bond >= 0) pair->free_stretch -= share * more;
        const double stiffness = pair->is_bonded       ? pair->bond_stiffness[NORMAL]
                                 : pair->contact.state ? pair->normal_stiffness
                                                       : 0;
        qs->largest_load = fmax(qs->largest_load, stiffness * share * all);
    }
    for (int i = 0; i < qs->n; i++)
        qs->shrinkage[i] = strain[i];
}

const double *quasi_static_shrinkage(const struct quasi_static *qs)
{
    return qs->shrinkage;
}
