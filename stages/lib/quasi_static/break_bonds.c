// SPDX-License-Identifier: GPL-3.0-or-later
// Bonds break one after another at their strength [K 4.41, 4.42]: the most overloaded
// first, and of those equal but for rounding the first listed, so that the order does
// not depend on the last digit. Equilibrium is found again before the next.
//
// `overload` is load over strength, normal and shear apart (contact_pair.h), so 1 is
// failure; FAILURE_THRESHOLD is a little below, for a bond that stands exactly at its
// strength must break on every machine. Strengths are in Pa for a parallel bond and in
// N for a contact bond, and are scaled by K/L or K L with K `stiffness`, L `length`.
#include "quasi_static_internal.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

static void record_crack(struct quasi_static *qs, struct contact_pair *pair, int mode)
{
    const int i = pair->grain[0];
    const struct vector from =
        add(qs->previous[i].translation, scale(pair->arm[0], pair->axis[0]));
    GROW_ARRAY(qs->crack, qs->n_crack, qs->crack_capacity);
    qs->crack[qs->n_crack++] = (struct dem_crack){
        .bond = pair->bond,
        .mode = (uint8_t)mode,
        .cycle = qs->iterations,
        .position = add(qs->packing->position[i], scale(qs->length, from))};
    pair_break_bond(pair, pair->deformation);
    qs->is_breaking = true;
}

static struct overload overload_of(const struct quasi_static *qs, int j)
{
    const struct contact_pair *pair = &qs->pair[j];
    const double unit = qs->setup.bond.kind == DEM_CONTACT_BOND // of strengths
                            ? qs->stiffness * qs->length
                            : qs->stiffness / qs->length;
    const double relative_strength =
        qs->setup.relative_strength ? qs->setup.relative_strength[pair->bond] : 1;
    return pair_overload(pair, qs->deformation[j],
                         relative_strength * qs->setup.bond.normal_strength / unit,
                         relative_strength * qs->setup.bond.shear_strength / unit);
}

bool break_most_overloaded(struct quasi_static *qs)
{
    const double equal = 1 - 1e-8;
    double *larger = NEW_ARRAY(double, qs->n_pair), most = 0;
    for (int j = 0; j < qs->n_pair; j++) {
        if (!qs->pair[j].is_bonded || qs->pair[j].is_detached) continue;
        const struct overload overload = overload_of(qs, j);
        larger[j] = fmax(overload.normal, overload.shear);
        most = fmax(most, larger[j]);
    }
    int worst = 0;
    while (most >= FAILURE_THRESHOLD && larger[worst] < equal * most)
        worst++;
    free(larger);
    if (!(most >= FAILURE_THRESHOLD)) return false;
    const struct overload overload = overload_of(qs, worst);
    record_crack(qs, &qs->pair[worst],
                 overload.normal >= overload.shear ? DEM_CRACK_NORMAL
                                                   : DEM_CRACK_SHEAR);
    return true;
}
