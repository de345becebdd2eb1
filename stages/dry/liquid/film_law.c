// SPDX-License-Identifier: GPL-3.0-or-later
// A film has the suction of the liquid that it is joined to, and a meniscus that is
// curved one way only: r = gamma / p_c. Gas enters a throat of radius R at p_c = 2
// gamma cos(theta) / R, so beside a cluster that is at the point of losing this throat
//     r = R / (2 cos theta).
// A throat has n corners, all alike, along its length L, and passes
//     rho n (C / 3 beta) gamma / (mu L) (r^3 - s^3)      kg/s
// (corner_film.c), with mu = rho nu. Scaled by lengths l and rates q this is
//     n (C / 3 beta) gamma l^2 / (nu q) / L (r^3 - s^3).
#include "film_law.h"

#include "corner_film.h"

#include <math.h>

struct film_law film_law_of(const struct drying_conditions *conditions,
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
        .step = films->step};
}
