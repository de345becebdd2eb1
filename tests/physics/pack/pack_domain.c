// SPDX-License-Identifier: GPL-3.0-or-later
// Domains: volumes by their formulas and by throwing points, and random places that are
// spread evenly over where a grain fits.
#include "../../test.h"
#include "pack/domain.h"

#include <math.h>
#include <stdlib.h>

enum { POINTS = 400000 };

static const double none = (double)NAN;

static struct domain_parameters said(int shape)
{
    return (struct domain_parameters){.shape = shape,
                                      .lower = {-1, 2, 3},
                                      .upper = {2, 6, 5},
                                      .centre = {4, -3, 7},
                                      .radius = 2,
                                      .inner_radius = 0.5,
                                      .height = 3,
                                      .cut_centre = {none, none, none},
                                      .cut_radius = 0.7,
                                      .cut_lower = {none, none, none},
                                      .cut_upper = {none, none, none}};
}

static struct domain made(const struct domain_parameters *parameters, int dimensions)
{
    struct domain domain;
    struct reason reason;
    assert_int_equal(domain_init(parameters, dimensions, 0.1, &domain, &reason),
                     STATUS_OK);
    return domain;
}

// A speck is held by the same share of the box as the volume says.
static void check_volume(const struct domain *domain, double expected)
{
    assert_true(fabs(domain_volume(domain) / expected - 1) < 1e-14);
    const struct vector edge = subtract(domain->upper, domain->lower);
    const double share = expected / (edge.x * edge.y * edge.z);
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    int held = 0;
    for (int k = 0; k < POINTS; k++) {
        const struct vector at = {gsl_rng_uniform(random) * edge.x,
                                  gsl_rng_uniform(random) * edge.y,
                                  gsl_rng_uniform(random) * edge.z};
        held += domain_holds(domain, add(domain->lower, at), 1e-9);
    }
    const double error = sqrt(share * (1 - share) / POINTS);
    assert_true(fabs((double)held / POINTS - share) < 3.5 * error + 1e-7);
    gsl_rng_free(random);
}

TEST(volumes)
{
    const double whole[] = {24, 12 * M_PI, 11.25 * M_PI, 32 * M_PI / 3};
    for (int shape = DOMAIN_BOX; shape <= DOMAIN_SPHERE; shape++) {
        const struct domain_parameters parameters = said(shape);
        const struct domain domain = made(&parameters, 3);
        check_volume(&domain, whole[shape]);
    }
}

TEST(volumes_with_cuts)
{
    const double whole[] = {24, 12 * M_PI, 11.25 * M_PI, 32 * M_PI / 3};
    for (int shape = DOMAIN_BOX; shape <= DOMAIN_SPHERE; shape++) {
        struct domain_parameters parameters = said(shape);
        const struct domain plain = made(&parameters, 3);
        // off centre, clear of the ring's inner wall
        const struct vector at = add(plain.centre, (struct vector){0.3, 1.22, 0.1});
        const double lower[3] = {at.x - 0.3, at.y - 0.2, at.z - 0.5};
        const double upper[3] = {at.x + 0.2, at.y + 0.1, at.z + 0.4};
        for (int axis = 0; axis < 3; axis++) {
            parameters.cut_centre[axis] = component(at, axis);
            parameters.cut_lower[axis] = lower[axis];
            parameters.cut_upper[axis] = upper[axis];
        }
        parameters.cut_radius = 0.25;
        const double cut[] = {0, 0.5 * 0.3 * 0.9, M_PI * 0.0625 * 0.9, M_PI / 48};
        for (int k = CUT_BOX; k <= CUT_SPHERE; k++) {
            parameters.cut = k;
            const struct domain domain = made(&parameters, 3);
            check_volume(&domain, whole[shape] - cut[k]);
        }
    }
}

TEST(cylinder_right_through)
{
    struct domain_parameters parameters = said(DOMAIN_CYLINDER);
    parameters.cut = CUT_CYLINDER;
    const struct domain pierced = made(&parameters, 3);
    check_volume(&pierced, M_PI * 3 * (4 - 0.49));
    parameters = said(DOMAIN_RING);
    parameters.inner_radius = 0.7;
    const struct domain ring = made(&parameters, 3);
    assert_true(fabs(domain_volume(&pierced) / domain_volume(&ring) - 1) < 1e-14);
}

TEST(discs)
{
    struct domain_parameters parameters = said(DOMAIN_SPHERE);
    parameters.cut = CUT_SPHERE;
    const struct domain domain = made(&parameters, 2);
    assert_true(fabs(domain.upper.y - domain.lower.y - 0.2) < 1e-15);
    assert_true(fabs(domain_volume(&domain) - 0.2 * M_PI * (4 - 0.49)) < 1e-14);
}

// A cut that repeats with the box is felt across the side.
TEST(cut_across_a_side)
{
    struct domain_parameters parameters = said(DOMAIN_BOX);
    parameters.periodic[0] = true;
    parameters.cut = CUT_SPHERE;
    const double centre[3] = {-0.3, 4, 4};
    for (int axis = 0; axis < 3; axis++)
        parameters.cut_centre[axis] = centre[axis];
    const struct domain domain = made(&parameters, 3);
    assert_true(domain_holds(&domain, (struct vector){1.9, 4, 4}, 0.09));
    assert_false(domain_holds(&domain, (struct vector){1.9, 4, 4}, 0.11));
}

// Second moments of places where a grain of radius 0.1 fits.
TEST(places_are_even)
{
    const double radius = 0.1;
    // of rho^2 in discs and rings, of r^2 in the sphere, of x^2 in the box
    const double moment[] = {2.8 * 2.8 / 12, 1.9 * 1.9 / 2, (1.9 * 1.9 + 0.6 * 0.6) / 2,
                             1.9 * 1.9 * 3 / 5};
    for (int shape = DOMAIN_BOX; shape <= DOMAIN_SPHERE; shape++) {
        const struct domain_parameters parameters = said(shape);
        const struct domain domain = made(&parameters, 3);
        gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
        double sum = 0, squares = 0, height = 0;
        for (int k = 0; k < POINTS; k++) {
            struct vector at;
            assert_true(domain_random_point(&domain, radius, random, &at));
            assert_true(domain_holds(&domain, at, radius));
            at = subtract(at, domain.centre);
            const double square = at.x * at.x +
                                  (shape == DOMAIN_BOX ? 0 : at.y * at.y) +
                                  (shape == DOMAIN_SPHERE ? at.z * at.z : 0);
            sum += square / POINTS;
            squares += square * square / POINTS;
            height += at.z / POINTS;
        }
        const double error = sqrt((squares - sum * sum) / POINTS);
        assert_true(fabs(sum - moment[shape]) < 3.5 * error);
        assert_true(fabs(height) < 3.5 * 2 / sqrt(POINTS));
        gsl_rng_free(random);
    }
}
