// SPDX-License-Identifier: GPL-3.0-or-later
// Random throat radii [K 2.2, 3.11] and their spatial correlation. For a correlation
// length l, the drawn radii are sorted and handed out in the order of a Gaussian random
// field
//     h(x) = sum over 1000 waves of cos(k.x + phase),  k normal with deviation 1/l,
// whose covariance is exp(-d^2 / (2 l^2)). So the distribution is exactly the drawn
// one. Where the box repeats k is rounded to a wave that repeats with it. Trap: a
// normal law is cut at 0, which shifts its mean and deviation (cut_normal): with
// end = -mean / deviation and hazard = phi(end) / Q(end) of the standard normal,
//     mean += deviation hazard,
//     deviation *= sqrt(1 - hazard (hazard - end)).
#include "network/throat_radius.h"

#include "basics/memory.h"
#include "basics/sorted.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>

// ---- one radius ---------------------------------------------------------------------

static double normal(gsl_rng *generator, double mean, double deviation)
{
    double radius;
    do
        radius = mean + gsl_ran_gaussian_ziggurat(generator, deviation);
    while (radius <= 0);
    return radius;
}

double cut_normal(double *mean, double *deviation)
{
    if (!(*deviation > 0)) return 0;
    const double end = -*mean / *deviation, left = gsl_cdf_ugaussian_Q(end);
    const double hazard = gsl_ran_ugaussian_pdf(end) / left;
    *mean += *deviation * hazard;
    *deviation *= sqrt(1 - hazard * (hazard - end));
    return gsl_cdf_ugaussian_P(end);
}

static double lognormal(gsl_rng *generator, double mean, double deviation)
{
    const double spread = deviation / mean;
    const double variance = log1p(spread * spread); // of ln r
    return mean * gsl_ran_lognormal(generator, -variance / 2, sqrt(variance));
}

static double draw(gsl_rng *generator, const struct radius_distribution *distribution)
{
    const double mean = distribution->mean, deviation = distribution->deviation;
    switch (distribution->law) {
    case RADIUS_LOGNORMAL:
        return lognormal(generator, mean, deviation);
    case RADIUS_UNIFORM:
        return mean + sqrt(3) * deviation * (2 * gsl_rng_uniform_pos(generator) - 1);
    case RADIUS_TWO_MODE:
        if (gsl_rng_uniform(generator) < distribution->second_share)
            return normal(generator, distribution->second_mean,
                          distribution->second_deviation);
        break;
    case RADIUS_NORMAL:
        break;
    }
    return normal(generator, mean, deviation);
}

// ---- which throat gets which --------------------------------------------------------

enum { WAVES = 1000 }; // their sum is Gaussian but for a thousandth

struct wave {
    struct vector number; // 1/m
    double phase;
};

// The nearest wave that repeats with the box.
static double repeating(const struct packing *packing, int axis, double number)
{
    const double longest =
        2 * M_PI / (component(packing->upper, axis) - component(packing->lower, axis));
    return packing->periodic[axis] ? longest * round(number / longest) : number;
}

// Waves whose numbers are normally distributed with deviation 1/l add up to a field of
// covariance exp(-d^2 / (2 l^2)).
static struct wave *draw_waves(gsl_rng *generator, const struct packing *packing,
                               double correlation_length)
{
    struct wave *wave = NEW_ARRAY(struct wave, WAVES);
    for (int k = 0; k < WAVES; k++) {
        for (int axis = 0; axis < 3; axis++) {
            const double number =
                gsl_ran_gaussian_ziggurat(generator, 1) / correlation_length;
            set_component(&wave[k].number, axis, repeating(packing, axis, number));
        }
        wave[k].phase = 2 * M_PI * gsl_rng_uniform(generator);
    }
    return wave;
}

static double height(const struct wave *wave, struct vector at)
{
    double sum = 0;
    for (int k = 0; k < WAVES; k++)
        sum += cos(dot(wave[k].number, at) + wave[k].phase);
    return sum;
}

struct ranked {
    double height;
    int throat;
};

static int compare_ranked(const void *a, const void *b)
{
    const struct ranked *first = a, *second = b;
    if (first->height != second->height) return first->height < second->height ? -1 : 1;
    return (first->throat > second->throat) - (first->throat < second->throat);
}

// Hands the radii out anew: the widest where the field is highest.
static void correlate(struct network *network, double correlation_length,
                      gsl_rng *generator)
{
    const size_t n = (size_t)network->n_throat;
    struct wave *wave = draw_waves(generator, &network->packing, correlation_length);
    struct ranked *order = NEW_ARRAY(struct ranked, n);
#pragma omp parallel for
    for (int t = 0; t < network->n_throat; t++) {
        const struct vector middle = throat_middle(network, t);
        order[t] =
            (struct ranked){height(wave, subtract(middle, network->packing.lower)), t};
    }
    qsort(order, n, sizeof *order, compare_ranked);
    double *radius = duplicate(network->throat_radius, n, sizeof *radius);
    qsort(radius, n, sizeof *radius, rising_doubles);
    for (size_t k = 0; k < n; k++)
        network->throat_radius[order[k].throat] = radius[k];
    free(radius);
    free(order);
    free(wave);
}

enum status draw_radii(struct network *network,
                       const struct radius_distribution *distribution,
                       struct reason *reason)
{
    const double least = distribution->mean - sqrt(3) * distribution->deviation;
    if (distribution->law == RADIUS_UNIFORM && least < 0)
        return refuse(
            reason, STATUS_BAD_DATA,
            "throat_radius.standard_deviation: uniform radii would reach down "
            "to %g m; must be at most mean / sqrt(3), %g m",
            least, distribution->mean / sqrt(3));
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(generator, distribution->seed);
    for (int t = 0; t < network->n_throat; t++)
        network->throat_radius[t] = draw(generator, distribution);
    if (distribution->correlation_length > 0 && network->n_throat)
        correlate(network, distribution->correlation_length, generator);
    gsl_rng_free(generator);
    free(network->throat_volume); // of other radii
    network->throat_volume = NULL;
    forget_throat_shapes(network);
    return STATUS_OK;
}
