// SPDX-License-Identifier: GPL-3.0-or-later
#include "bonds.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

static const double rounding = 1e-6; // of the sum of the radii, as pack.touching_gap

void bond_grains(struct packing *packing, enum bonds_by by, double gap)
{
    if (by == BONDS_BY_PACKING) return;
    free(packing->bond);
    packing->bond = neighbour_pairs(packing, by == BONDS_BY_DISTANCE ? gap : rounding,
                                    &packing->n_bond);
}

// Where the distribution, of mean 1 but for the cut, has the share U in (0,1) below it.
static double strength_at(const struct strength_scatter *scatter, double u)
{
    if (scatter->law == STRENGTH_WEIBULL) {
        const double size = 1 / tgamma(1 + 1 / scatter->modulus);
        return gsl_cdf_weibull_Pinv(u, size, scatter->modulus);
    }
    // From above, where nothing is cut off and no digit of a small share is lost.
    const double kept = gsl_cdf_ugaussian_P(1 / scatter->variation);
    return 1 + scatter->variation * gsl_cdf_ugaussian_Qinv((1 - u) * kept);
}

double *draw_strengths(const struct strength_scatter *scatter, int n_bond)
{
    const bool same = scatter->law == STRENGTH_NORMAL && !(scatter->variation > 0);
    if (scatter->law == STRENGTH_ONE || same) return NULL;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(random, (unsigned long)scatter->seed);
    double *strength = NEW_ARRAY(double, n_bond);
    for (int b = 0; b < n_bond; b++)
        strength[b] = fmax(0, strength_at(scatter, gsl_rng_uniform_pos(random)));
    gsl_rng_free(random);
    return strength;
}
