// SPDX-License-Identifier: GPL-3.0-or-later
// A film has the suction of the liquid that it is joined to, and a meniscus that is
// curved one way only: r = gamma / p_c. Gas enters a throat of radius R at p_c = 2
// gamma cos(theta) / R, so beside a cluster that is at the point of losing this throat
//     r = R / (2 cos theta).
// A throat has n corners, all alike, along its length L, and passes
//     rho n (C / 3 beta) gamma / (mu L) (r^3 - s^3)      kg/s
// (corner_film.c), with mu = rho nu. Scaled by lengths l and rates q this is
//     n (C / 3 beta) gamma l^2 / (nu q) / L (r^3 - s^3).
//
// Under gravity the flow along a corner is as C r^4 / beta mu times the fall of
//     -gamma / r + rho g z,
// which is -gamma / r_top but for a constant: so with levels u = r_top^3 it is
//     n (C / 3 beta) gamma / mu (r / r_top)^4 du/dz.
// The ratio is taken at the mean level and the mean height of the two ends: an error as
// the square of their distance, no flow in liquid at rest, and no jump where a film
// ends.
#include "film_law.h"

#include "corner_film.h"

#include <math.h>

static double largest_radius(const struct network *network)
{
    double largest = 0;
    for (int t = 0; t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK)
            largest = fmax(largest, network->throat_radius[t]);
    return largest;
}

struct film_law film_law_of(const struct network *network,
                            const struct drying_conditions *conditions,
                            const struct drying_scale *scale)
{
    const double degree = M_PI / 180, angle = conditions->contact_angle * degree;
    const struct film_conditions *films = &conditions->films;
    return (struct film_law){
        .conductance = films->conductance * films->corners *
                       corner_conductance(films->half_angle * degree, angle) *
                       conditions->surface_tension * (scale->length * scale->length) /
                       (conditions->viscosity * scale->rate),
        .curvature = 1 / (2 * cos(angle)),
        .step = films->step,
        .weight = conditions->liquid_density * conditions->gravity *
                  (scale->length * scale->length) / conditions->surface_tension,
        .thickest = largest_radius(network) / scale->length / (2 * cos(angle))};
}

double film_level(const struct film_law *law, double radius, double depth)
{
    const double top =
        law->weight > 0 ? 1 / (1 / radius + law->weight * depth) : radius;
    return top * top * top;
}

double film_flow_ratio(const struct film_law *law, double level, double depth)
{
    const double top = cbrt(fmax(0, level));
    const double share = 1 - law->weight * depth * top; // of 1 / r_top that is 1 / r
    const double most = law->thickest / top;
    const double ratio = share * most > 1 ? 1 / share : most;
    return (ratio * ratio) * (ratio * ratio);
}
