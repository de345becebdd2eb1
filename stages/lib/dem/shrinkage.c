// SPDX-License-Identifier: GPL-3.0-or-later
// Drying shrinkage: an eigenstrain of each grain, which its bonds and contacts follow.
//
// With R and R_j the radii at the start, e and e_j the shrinkage (linear strain, > 0
// smaller), l the distance at the start and U the overlap there:
//     place.radius     = R (1 - e)
//     pair.overlap     = U - (R e + R_j e_j)
//     free_stretch     = -l (R e + R_j e_j) / (R + R_j)
//     tension of bond  = k^n A (stretch - free_stretch)            [pair_bond.h]
// so that a free body shrinks without any force, and between grains held apart a bond
// of e = e_j carries k^n A l e. As the incremental form dN = k^n A l de (Potyondy &
// Cundall 2004 have the bonds), but without the drift of a sum. The mass stays.
#include "dem/engine.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

void take_shrinkage(struct dem *dem, const struct dem_setup *setup)
{
    if (!setup->shrinks) return;
    dem->shrinkage = NEW_ARRAY(double, dem->n_particle);
    dem->first_radius = NEW_ARRAY(double, dem->n_particle);
    for (int i = 0; i < dem->n_particle; i++)
        dem->first_radius[dem->id[i]] = dem->place[i].radius;
}

// Radii, which the search for pairs and new contacts go by.
static void shrink_grains(struct dem *dem)
{
    dem->largest_radius = 0;
    dem->smallest_radius = INFINITY;
    for (int i = 0; i < dem->n_particle; i++) {
        const int who = dem->id[i];
        const double radius = dem->first_radius[who] * (1 - dem->shrinkage[who]);
        dem->place[i].radius = radius;
        dem->largest_radius = fmax(dem->largest_radius, radius);
        dem->smallest_radius = fmin(dem->smallest_radius, radius);
    }
}

// What the radii of PAIR lose together, and lose more than by the shrinkage BEFORE.
static double shortening(const struct dem *dem, int pair, const double *before)
{
    double sum = 0;
    for (int end = 0; end < 2; end++) {
        const int who = dem->id[dem->pairs.particle[pair][end]];
        const double more = dem->shrinkage[who] - (before ? before[who] : 0);
        sum += dem->first_radius[who] * more;
    }
    return sum;
}

static void shrink_pair(struct dem *dem, int pair, const double *before)
{
    const int group = pair / PAIRS_IN_GROUP, lane = pair % PAIRS_IN_GROUP;
    struct pair_group *g = &dem->pairs.group[group];
    g->overlap[lane] -= shortening(dem, pair, before);
    if (!dem->pairs.bonds) return;
    const int32_t *end = dem->pairs.particle[pair];
    const double whole =
        dem->first_radius[dem->id[end[0]]] + dem->first_radius[dem->id[end[1]]];
    dem->pairs.bonds[group].free_stretch[lane] =
        -g->distance[lane] * shortening(dem, pair, NULL) / whole;
}

// Its work counts as gained, as that of rescaling. Grains that swell come nearer: the
// search is told.
void dem_set_shrinkage(struct dem *dem, const double *shrinkage)
{
    if (!dem->shrinkage) return;
    const double elastic = dem->balance_energy ? elastic_energy(dem) : 0;
    double *before = duplicate(dem->shrinkage, (size_t)dem->n_particle, sizeof *before);
    double swelling = 0;
    for (int i = 0; i < dem->n_particle; i++) {
        dem->shrinkage[i] = shrinkage[i];
        swelling = fmax(swelling, (before[i] - shrinkage[i]) * dem->first_radius[i]);
    }
    shrink_grains(dem);
    for (int p = 0; p < dem->pairs.n_pair; p++)
        shrink_pair(dem, p, before);
    free(before);
    count_approach(dem, swelling);
    if (dem->balance_energy) dem->energy_ledger.gained += elastic_energy(dem) - elastic;
}

void dem_shrinkage(const struct dem *dem, double *shrinkage)
{
    for (int i = 0; i < dem->n_particle; i++)
        shrinkage[i] = dem->shrinkage ? dem->shrinkage[i] : 0;
}
