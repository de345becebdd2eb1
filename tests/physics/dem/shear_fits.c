// SPDX-License-Identifier: GPL-3.0-or-later
// The fits of shearstats to what has a closed form, and their standard errors:
// intervals of 95 % over many draws of scatter must hold the truth in 95 % of them. And
// the line integral of a contact beside its closed form.
#include "../../test.h"

#include "basics/memory.h"
#include "shearstats/band_fit.h"
#include "shearstats/rheology.h"
#include "shearstats/sums.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_randist.h>
#include <math.h>
#include <stdlib.h>

enum { POINTS = 40, DRAWS = 4000 };
// Of DRAWS draws with a chance of 0.95: three standard deviations.
static const double COVERAGE_ERROR = 3 * 0.00345;

static void profile(double centre, double width, double smoothing, double *r, double *y)
{
    const double spread = sqrt(width * width + 2 * smoothing * smoothing);
    for (int k = 0; k < POINTS; k++) {
        r[k] = 0.1 + 0.004 * k;
        y[k] = 0.5 + 0.5 * erf((r[k] - centre) / spread);
    }
}

TEST(band_is_found)
{
    double r[POINTS], y[POINTS];
    for (double width = 0.005; width < 0.05; width *= 2)
        for (double smoothing = 0; smoothing < 0.015; smoothing += 0.005) {
            profile(0.17, width, smoothing, r, y);
            const struct band_fit fit = fit_band(r, y, POINTS, smoothing);
            assert_true(fit.converged);
            assert_float_equal(fit.centre, 0.17, 1e-9);
            assert_float_equal(fit.width, width, 1e-8);
        }
}

TEST(no_band)
{
    double r[POINTS], y[POINTS];
    profile(0.17, 0.02, 0, r, y);
    assert_false(fit_band(r, y, 3, 0).converged); // too few
    for (int k = 0; k < POINTS; k++)
        y[k] = 0; // nothing turns
    assert_false(fit_band(r, y, POINTS, 0).converged);
}

TEST(band_errors)
{
    const double t = gsl_cdf_tdist_Pinv(0.975, POINTS - 2);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    double r[POINTS], y[POINTS], noisy[POINTS];
    profile(0.17, 0.02, 0.004, r, y);
    int centre = 0, width = 0;
    for (int draw = 0; draw < DRAWS; draw++) {
        for (int k = 0; k < POINTS; k++)
            noisy[k] = y[k] + gsl_ran_gaussian(rng, 0.02);
        const struct band_fit fit = fit_band(r, noisy, POINTS, 0.004);
        assert_true(fit.converged);
        centre += fabs(fit.centre - 0.17) < t * fit.centre_error;
        width += fabs(fit.width - 0.02) < t * fit.width_error;
    }
    gsl_rng_free(rng);
    assert_float_equal((double)centre / DRAWS, 0.95, COVERAGE_ERROR);
    assert_float_equal((double)width / DRAWS, 0.95, COVERAGE_ERROR);
}

TEST(line_errors)
{
    const double t = gsl_cdf_tdist_Pinv(0.975, POINTS - 2);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    double p[POINTS], tau[POINTS];
    int friction = 0, cohesion = 0;
    for (int draw = 0; draw < DRAWS; draw++) {
        for (int k = 0; k < POINTS; k++) {
            p[k] = 5 + 3 * k;
            tau[k] = 0.13 * p[k] + 1.3 + gsl_ran_gaussian(rng, 0.5);
        }
        const struct line_fit fit = fit_line(p, tau, POINTS);
        friction += fabs(fit.friction - 0.13) < t * fit.friction_error;
        cohesion += fabs(fit.cohesion - 1.3) < t * fit.cohesion_error;
    }
    gsl_rng_free(rng);
    assert_float_equal((double)friction / DRAWS, 0.95, COVERAGE_ERROR);
    assert_float_equal((double)cohesion / DRAWS, 0.95, COVERAGE_ERROR);
}

// The integral of the kernel's share up to U, an even function's tenth-degree integral:
// with I(u) = 35/32 (u^2/2 - u^4/4 + u^6/10 - u^8/56) + u/2 + c inside, 0 below, u
// above.
static double integrated_share(double u)
{
    if (u <= -1) return 0;
    if (u >= 1) return u;
    const double s = u * u;
    const double c = 0.5 - 35.0 / 32 * (0.5 - 0.25 + 0.1 - 1.0 / 56);
    return 35.0 / 32 * s * (0.5 - s * (0.25 - s * (0.1 - s / 56))) + 0.5 * u + c;
}

// One contact along x from 0 to its length, in cells along x: the share of the cell
// [a, b] is int_0^1 Phi((b - s l) / h) - Phi((a - s l) / h) ds.
TEST(line_integral)
{
    const double length = 1,
                 half_width = 1.5; // the default: half a diameter, three times
    struct grid grid = {
        .axis = {{.lower = -3, .spacing = 0.5, .n = 14, .half_width = half_width},
                 {.lower = -1, .spacing = 2, .n = 1, .everywhere = true},
                 {.lower = -1, .spacing = 2, .n = 1, .everywhere = true}}};
    struct vector place[2] = {{0, 0, 0}, {length, 0, 0}}, rest[2] = {{0}};
    struct vector force = {1, 0, 0}, point = {0.5, 0, 0};
    double mass[2] = {1, 1}, radius[2] = {0.5, 0.5}, overlap = 0;
    uint8_t driven[2] = {0, 0};
    int32_t pair[1][2] = {{0, 1}};
    int64_t first[2] = {0, 1};
    const struct motion motion = {.n_particle = 2,
                                  .n_snapshot = 1,
                                  .last = 1,
                                  .radius = radius,
                                  .mass = mass,
                                  .driven = driven,
                                  .position = place,
                                  .velocity = rest,
                                  .contact_first = first,
                                  .pair = pair,
                                  .force = &force,
                                  .point = &point,
                                  .overlap = &overlap};
    const struct frame frame = {.cylindrical = false};
    double *sum = NEW_ARRAY(double, 14 * SUM_ALL), worst = 0;
    add_snapshot(&motion, 0, &frame, &grid, sum);
    for (int k = 0; k < 14; k++) {
        const double a = -3 + 0.5 * k, b = a + 0.5;
        const double upper = integrated_share(b / half_width) -
                             integrated_share((b - length) / half_width);
        const double lower = integrated_share(a / half_width) -
                             integrated_share((a - length) / half_width);
        const double exact = (upper - lower) * half_width / length;
        worst = fmax(worst, fabs(sum[k * SUM_ALL + SUM_CONTACT] - length * exact));
    }
    free(sum);
    print_message("# largest error of the line integral: %.2g of the contact's\n",
                  worst);
    assert_true(worst < 1e-5);
}
