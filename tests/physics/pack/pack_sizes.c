// SPDX-License-Identifier: GPL-3.0-or-later
// Drawn radii against the density that was asked for, integrated here on its own: mean,
// variance and the whole distribution, by number and by mass, to 1:50.
#include "../../test.h"
#include "pack/sizes.h"

#include "basics/memory.h"

#include <gsl/gsl_sort.h>
#include <math.h>
#include <stdlib.h>

enum { DRAWS = 200000, BINS = 200000 };

// Share of the grains, or of their mass, per radius, to any factor.
typedef double density(double radius, const struct size_parameters *p);

static double even(double radius, const struct size_parameters *p)
{
    (void)radius, (void)p;
    return 1;
}

static double power(double radius, const struct size_parameters *p)
{
    return pow(radius / p->largest, -p->exponent);
}

static double normal(double radius, const struct size_parameters *p)
{
    const double z = (radius / p->radius - 1) / p->spread;
    return exp(-z * z / 2);
}

static double lognormal(double radius, const struct size_parameters *p)
{
    const double variance = log(1 + p->spread * p->spread);
    const double z = log(radius / p->radius) + variance / 2;
    return exp(-z * z / 2 / variance) / radius;
}

static double sieve(double radius, const struct size_parameters *p)
{
    int k = 0;
    while (k < p->sieve_radii.count - 2 && radius > p->sieve_radii.value[k + 1])
        k++;
    return (p->sieve_passing.value[k + 1] - p->sieve_passing.value[k]) /
           (p->sieve_radii.value[k + 1] - p->sieve_radii.value[k]);
}

// By the midpoint rule in ln r: cumulative share by number, and central moments.
struct expected {
    double *edge, *share; // (BINS + 1)
    double mean, variance, fourth;
};

static struct expected integrate(density *stated, const struct size_parameters *p,
                                 const struct sizes *sizes)
{
    struct expected e = {.edge = NEW_ARRAY(double, BINS + 1),
                         .share = NEW_ARRAY(double, BINS + 1)};
    const double step = log(sizes->largest / sizes->smallest) / BINS;
    double *weight = NEW_ARRAY(double, BINS), *middle = NEW_ARRAY(double, BINS);
    for (int k = 0; k < BINS; k++) {
        const double r = middle[k] = sizes->smallest * exp((k + 0.5) * step);
        const double mass = p->by == SHARE_OF_MASS ? pow(r / sizes->smallest, 3) : 1;
        weight[k] = stated(r, p) * r / mass;
        e.edge[k + 1] = sizes->smallest * exp((k + 1) * step);
        e.share[k + 1] = e.share[k] + weight[k];
    }
    e.edge[0] = sizes->smallest;
    const double total = e.share[BINS];
    for (int k = 0; k < BINS; k++)
        e.mean += weight[k] / total * middle[k];
    for (int k = 0; k < BINS; k++) {
        const double off = middle[k] - e.mean;
        e.variance += weight[k] / total * off * off;
        e.fourth += weight[k] / total * off * off * off * off;
    }
    for (int k = 0; k <= BINS; k++)
        e.share[k] /= total;
    free(weight);
    free(middle);
    return e;
}

// Kolmogorov and Smirnov: the largest difference of the distributions, times sqrt(n).
static double difference(const struct expected *e, const double *sorted)
{
    double largest = 0;
    for (int i = 0, k = 0; k <= BINS; k++) {
        while (i < DRAWS && sorted[i] <= e->edge[k])
            i++;
        largest = fmax(largest, fabs((double)i / DRAWS - e->share[k]));
    }
    return largest * sqrt(DRAWS);
}

static void check(density *stated, const struct size_parameters *p)
{
    struct sizes sizes;
    struct reason reason;
    assert_int_equal(sizes_prepare(p, &sizes, &reason), STATUS_OK);
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(random, 5);
    double *radius = sizes_draw_many(&sizes, DRAWS, random);
    gsl_sort(radius, 1, DRAWS);
    assert_true(radius[0] >= sizes.smallest && radius[DRAWS - 1] <= sizes.largest);

    struct expected e = integrate(stated, p, &sizes);
    double mean = 0, variance = 0;
    for (int i = 0; i < DRAWS; i++)
        mean += radius[i] / DRAWS;
    for (int i = 0; i < DRAWS; i++)
        variance += (radius[i] - mean) * (radius[i] - mean) / (DRAWS - 1);
    const double mean_error = sqrt(e.variance / DRAWS);
    const double variance_error = sqrt((e.fourth - e.variance * e.variance) / DRAWS);
    assert_true(fabs(mean - e.mean) < 3.5 * mean_error);
    assert_true(fabs(variance - e.variance) < 3.5 * variance_error);
    assert_true(difference(&e, radius) < 1.95); // exceeded once in a thousand
    free(e.edge);
    free(e.share);
    free(radius);
    gsl_rng_free(random);
}

static void check_both(density *stated, struct size_parameters parameters)
{
    parameters.by = SHARE_OF_NUMBER;
    check(stated, &parameters);
    parameters.by = SHARE_OF_MASS;
    check(stated, &parameters);
}

static struct size_parameters said(int distribution)
{
    return (struct size_parameters){.distribution = distribution,
                                    .radius = 2e-7,
                                    .smallest = (double)NAN,
                                    .largest = (double)NAN,
                                    .spread = 0.3,
                                    .second_radius = (double)NAN};
}

TEST(even_sizes)
{
    struct size_parameters parameters = said(SIZES_UNIFORM);
    parameters.smallest = 1e-8;
    parameters.largest = 5e-7;
    check_both(even, parameters);
}

TEST(power_laws)
{
    struct size_parameters parameters = said(SIZES_POWER);
    parameters.smallest = 2;
    parameters.largest = 100;
    for (double exponent = -2; exponent <= 4; exponent += 1) {
        parameters.exponent = exponent;
        check_both(power, parameters);
    }
}

TEST(normal_sizes)
{
    struct size_parameters parameters = said(SIZES_NORMAL);
    check_both(normal, parameters);
    parameters.spread = 0.05;
    check_both(normal, parameters);
    parameters.spread = 1;
    parameters.smallest = 2e-8;
    parameters.largest = 1e-6;
    check_both(normal, parameters);
    parameters.spread = 0.1; // only its upper tail
    parameters.smallest = 2.6e-7;
    check_both(normal, parameters);
}

TEST(lognormal_sizes)
{
    struct size_parameters parameters = said(SIZES_LOGNORMAL);
    check_both(lognormal, parameters);
    parameters.spread = 1;
    parameters.smallest = 5e-8;
    parameters.largest = 2.5e-6;
    check_both(lognormal, parameters);
}

TEST(sieve_curves)
{
    struct size_parameters parameters = said(SIZES_SIEVE);
    parameters.sieve_radii = (struct number_list){5, {1e-3, 2e-3, 4e-3, 1e-2, 5e-2}};
    parameters.sieve_passing = (struct number_list){5, {0, 0.1, 0.1, 0.6, 1}};
    check_both(sieve, parameters);
}

// Untruncated lognormal: closed forms for all it takes, not our own integral.
TEST(lognormal_moments)
{
    const struct size_parameters parameters = said(SIZES_LOGNORMAL);
    struct sizes sizes;
    struct reason reason;
    assert_int_equal(sizes_prepare(&parameters, &sizes, &reason), STATUS_OK);
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    double mean = 0, square = 0;
    for (int i = 0; i < DRAWS; i++) {
        const double radius = sizes_draw(&sizes, random) / parameters.radius;
        mean += radius / DRAWS;
        square += radius * radius / DRAWS;
    }
    assert_true(fabs(mean - 1) < 3.5 * 0.3 / sqrt(DRAWS));
    assert_true(fabs(square - 1.09) < 3.5 * 0.7 / sqrt(DRAWS));
    gsl_rng_free(random);
}

// Share by number, and the mass it makes.
static void check_modes(int by, double share, double expected)
{
    struct size_parameters parameters = said(SIZES_TWO_MODE);
    parameters.radius = 1;
    parameters.second_radius = 0.02;
    parameters.second_share = share;
    parameters.by = by;
    struct sizes sizes;
    struct reason reason;
    assert_int_equal(sizes_prepare(&parameters, &sizes, &reason), STATUS_OK);
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    int second = 0;
    for (int i = 0; i < DRAWS; i++)
        second += sizes_draw(&sizes, random) == 0.02;
    const double error = sqrt(expected * (1 - expected) / DRAWS);
    assert_true(fabs((double)second / DRAWS - expected) <= 3.5 * error);
    gsl_rng_free(random);
}

TEST(two_modes)
{
    check_modes(SHARE_OF_NUMBER, 0.25, 0.25);
    check_modes(SHARE_OF_NUMBER, 0, 0);
    check_modes(SHARE_OF_NUMBER, 1, 1);
    // 0.001 of the mass in grains 125,000 times lighter: 125 of 125.999 shares
    check_modes(SHARE_OF_MASS, 0.001, 125 / 125.999);
}
