// SPDX-License-Identifier: GPL-3.0-or-later
// Least squares for [G 13],
//     turned = 1/2 + 1/2 erf((r - centre) / spread),
// by Levenberg and Marquardt (GSL), in units of the length of the profile. Smoothing by
// a kernel of standard deviation s widens an error function to
//     spread^2 = width^2 + 2 s^2
// (exact for a Gaussian), so that width is that of the flow, and
//     width error = spread error * spread / width.
// Errors are from the covariance (J^T J)^-1 times the mean square residual.
//
// The spread may come out below 0 (the curve is odd in it), so its absolute value
// counts. The fit is accepted if the centre lies within the profile and the spread is
// below twice its length: beyond that an error function through the data is a straight
// line, and centre and spread are not separate numbers.
#include "band_fit.h"

#include "basics/memory.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <math.h>
#include <stdlib.h>

struct profile {
    int n;
    double *x; // scaled
    const double *turned;
};

static int residuals(const gsl_vector *p, void *data, gsl_vector *f)
{
    const struct profile *profile = data;
    const double centre = gsl_vector_get(p, 0), spread = gsl_vector_get(p, 1);
    for (int k = 0; k < profile->n; k++)
        gsl_vector_set(f, (size_t)k,
                       0.5 + 0.5 * erf((profile->x[k] - centre) / spread) -
                           profile->turned[k]);
    return GSL_SUCCESS;
}

// d turned / d centre = -exp(-u^2) / (sqrt(pi) spread), and d turned / d spread is u
// times that.
static int jacobian(const gsl_vector *p, void *data, gsl_matrix *j)
{
    const struct profile *profile = data;
    const double centre = gsl_vector_get(p, 0), spread = gsl_vector_get(p, 1);
    for (int k = 0; k < profile->n; k++) {
        const double u = (profile->x[k] - centre) / spread;
        const double slope = -exp(-u * u) / (sqrt(M_PI) * spread);
        gsl_matrix_set(j, (size_t)k, 0, slope);
        gsl_matrix_set(j, (size_t)k, 1, slope * u);
    }
    return GSL_SUCCESS;
}

// Where the profile first crosses a half, and the spread of its steepest rise. The
// slope at the centre of an error function is 1 / (sqrt(pi) spread). Backwards, so that
// the crossing nearest to the inner side wins; within 1e-3 and 1 of the profile's
// length.
static void guess(const struct profile *profile, double start[2])
{
    double steepest = 0;
    start[0] = 0.5;
    for (int k = profile->n - 1; k > 0; k--) {
        const double rise = profile->turned[k] - profile->turned[k - 1];
        const double run = profile->x[k] - profile->x[k - 1];
        steepest = fmax(steepest, rise / run);
        if (profile->turned[k - 1] < 0.5 && profile->turned[k] >= 0.5)
            start[0] = profile->x[k - 1] + run * (0.5 - profile->turned[k - 1]) / rise;
    }
    start[1] = steepest > 0 ? fmin(fmax(1 / (sqrt(M_PI) * steepest), 1e-3), 1) : 0.2;
}

// GSL's covariance is (J^T J)^-1, without the scatter. Of a width below the smoothing
// only the error of the spread is known.
static void read_fit(const gsl_multifit_nlinear_workspace *work, int n, double unit,
                     double from, double smoothing, struct band_fit *fit)
{
    gsl_matrix *covariance = gsl_matrix_alloc(2, 2);
    gsl_multifit_nlinear_covar(gsl_multifit_nlinear_jac(work), 0, covariance);
    double square = 0;
    gsl_blas_ddot(gsl_multifit_nlinear_residual(work),
                  gsl_multifit_nlinear_residual(work), &square);
    const double scatter = sqrt(square / (n - 2));
    const gsl_vector *found = gsl_multifit_nlinear_position(work);
    const double centre = gsl_vector_get(found, 0);
    const double spread = unit * fabs(gsl_vector_get(found, 1));
    const double error = unit * scatter * sqrt(gsl_matrix_get(covariance, 1, 1));
    const double square_width = spread * spread - 2 * smoothing * smoothing;
    fit->centre = from + unit * centre;
    fit->centre_error = unit * scatter * sqrt(gsl_matrix_get(covariance, 0, 0));
    fit->width = sqrt(fmax(square_width, 0));
    fit->width_error = square_width > 0 ? error * spread / fit->width : error;
    fit->residual = sqrt(square / n);
    fit->converged = centre > 0 && centre < 1 && spread < 2 * unit &&
                     isfinite(fit->centre_error) && isfinite(fit->width_error);
    gsl_matrix_free(covariance);
}

// With the length of the profile as unit, tolerances and bounds are numbers without a
// scale.
struct band_fit fit_band(const double *r, const double *turned, int n, double smoothing)
{
    enum { MIN_POINTS = 4, MOST_STEPS = 200 };
    struct band_fit fit = {0};
    if (n < MIN_POINTS) return fit;
    const double unit = r[n - 1] - r[0];
    struct profile profile = {n, NEW_ARRAY(double, n), turned};
    for (int k = 0; k < n; k++)
        profile.x[k] = (r[k] - r[0]) / unit;
    double start[2];
    guess(&profile, start);

    gsl_multifit_nlinear_parameters how = gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_workspace *work =
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &how, (size_t)n, 2);
    gsl_multifit_nlinear_fdf function = {
        .f = residuals, .df = jacobian, .n = (size_t)n, .p = 2, .params = &profile};
    gsl_vector_view begin = gsl_vector_view_array(start, 2);
    int why = 0;
    gsl_multifit_nlinear_init(&begin.vector, &function, work);
    const int status = gsl_multifit_nlinear_driver(MOST_STEPS, 1e-10, 1e-10, 0, NULL,
                                                   NULL, &why, work);
    // Without scatter no step helps at the end: that is a solution, too.
    if (status == GSL_SUCCESS || status == GSL_ENOPROG)
        read_fit(work, n, unit, r[0], smoothing, &fit);
    gsl_multifit_nlinear_free(work);
    free(profile.x);
    return fit;
}
