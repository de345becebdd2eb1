// SPDX-License-Identifier: GPL-3.0-or-later
// Bond strengths from one uniform number u each: Weibull's by its inverse, with the
// scale 1 / Gamma(1 + 1/m) for mean 1; normal ones, cut off at 0, as 1 + variation
// Q^-1((1 - u) P), P the probability above the cut. Numbers are dealt out in the order
// of the bonds' places, measured in integer ticks of the extent, so that neither the
// numbering of grains nor rounding, as from another unit of length, changes which bond
// gets which.
#include "bonds.h"

#include "basics/memory.h"
#include "geometry/neighbours.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

// The quantile of U in (0,1); the distribution has mean 1 before the cut.
static double strength_at(const struct strength_scatter *scatter, double u)
{
    if (scatter->law == STRENGTH_WEIBULL) {
        const double size = 1 / tgamma(1 + 1 / scatter->modulus);
        return gsl_cdf_weibull_Pinv(u, size, scatter->modulus);
    }
    // By the upper tail, where nothing is cut off and small probabilities keep digits.
    const double kept = gsl_cdf_ugaussian_P(1 / scatter->variation);
    return 1 + scatter->variation * gsl_cdf_ugaussian_Qinv((1 - u) * kept);
}

double *draw_strengths(const struct strength_scatter *scatter, int n)
{
    const bool same = scatter->law == STRENGTH_NORMAL && !(scatter->variation > 0);
    if (scatter->law == STRENGTH_ONE || same) return NULL;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(random, (unsigned long)scatter->seed);
    double *strength = NEW_ARRAY(double, n);
    for (int k = 0; k < n; k++)
        strength[k] = fmax(0, strength_at(scatter, gsl_rng_uniform_pos(random)));
    gsl_rng_free(random);
    return strength;
}

// ---- in order of place --------------------------------------------------------------

// Ticks in the extent of the grains: places equal to rounding have equal ticks.
static const double TICKS = 0x1p30;

struct ruler {
    const struct packing *packing;
    struct vector zero; // lowest coordinates of the grains, m
    double extent;      // of the grains, m
};

enum { KEYS = 6 };

struct placed_bond {
    int64_t key[KEYS]; // what has the lowest first key is the first, and so on
    int bond;
};

static struct ruler ruler_init(const struct packing *packing)
{
    struct ruler ruler = {.packing = packing};
    for (int axis = 0; axis < 3; axis++) {
        double lower = INFINITY, upper = -INFINITY;
        for (int i = 0; i < packing->n_particle; i++) {
            lower = fmin(lower, component(packing->position[i], axis));
            upper = fmax(upper, component(packing->position[i], axis));
        }
        set_component(&ruler.zero, axis, lower);
        ruler.extent = fmax(ruler.extent, upper - lower);
    }
    return ruler;
}

static int64_t ticks(const struct ruler *ruler, double length)
{
    return ruler->extent > 0 ? llround(length / ruler->extent * TICKS) : 0;
}

// The place along AXIS in ticks, within one period of a periodic box.
static int64_t place_along(const struct ruler *ruler, struct vector place, int axis)
{
    const struct packing *packing = ruler->packing;
    const double at = component(place, axis) - component(ruler->zero, axis);
    if (!packing->periodic[axis]) return ticks(ruler, at);
    const double box =
        component(packing->upper, axis) - component(packing->lower, axis);
    const int64_t within = ticks(ruler, at - box * floor(at / box));
    return within < ticks(ruler, box) ? within : 0;
}

static struct placed_bond measure(const struct ruler *ruler, int bond)
{
    const struct packing *packing = ruler->packing;
    const int32_t *end = packing->bond[bond];
    const struct vector along = nearest_image(packing, end[0], end[1]);
    const struct vector middle = add(packing->position[end[0]], scale(0.5, along));
    const int64_t z = ticks(ruler, along.z), x = ticks(ruler, along.x),
                  y = ticks(ruler, along.y);
    const int up = (z ? z : x ? x : y) < 0 ? -1 : 1; // whichever grain comes first
    return (struct placed_bond){
        {-place_along(ruler, middle, 2), place_along(ruler, middle, 0),
         place_along(ruler, middle, 1), -up * z, -up * x, -up * y},
        bond};
}

static int compare_places(const void *a, const void *b)
{
    const struct placed_bond *p = a, *q = b;
    for (int k = 0; k < KEYS; k++)
        if (p->key[k] != q->key[k]) return p->key[k] < q->key[k] ? -1 : 1;
    return (p->bond > q->bond) - (p->bond < q->bond);
}

double *equal_strengths(int n)
{
    double *strength = NEW_ARRAY(double, n);
    for (int b = 0; b < n; b++)
        strength[b] = 1;
    return strength;
}

// N strengths DRAWN, to the bonds of PACKING.
static double *give_by_place(const struct packing *packing, const double *drawn, int n)
{
    const struct ruler ruler = ruler_init(packing);
    struct placed_bond *placed = NEW_ARRAY(struct placed_bond, n);
    for (int b = 0; b < n; b++)
        placed[b] = measure(&ruler, b);
    qsort(placed, (size_t)n, sizeof *placed, compare_places);
    double *strength = NEW_ARRAY(double, n);
    for (int k = 0; k < n; k++)
        strength[placed[k].bond] = drawn[k];
    free(placed);
    return strength;
}

double *bond_strengths(const struct strength_scatter *scatter,
                       const struct packing *packing)
{
    const int n = packing->n_bond;
    const double *own = packing->bond_strength;
    double *drawn = draw_strengths(scatter, n);
    if (!drawn) return copy_bond_strengths(packing);
    double *strength = give_by_place(packing, drawn, n);
    for (int b = 0; own && b < n; b++)
        strength[b] *= own[b];
    free(drawn);
    return strength;
}
