// SPDX-License-Identifier: GPL-3.0-or-later
// Radii by inversion of the cumulative distribution, truncated to [smallest, largest].
// A distribution by mass is drawn by number: the number density is the mass density
// over r^3, so
//     power law      exponent + 3,
//     lognormal      mean of ln r lower by 3 variances, the same variance,
//     normal         no closed inverse: pieces with a truncated normal, thinned by
//                    rejection with (low / r)^3,
//     sieve          piecewise constant mass density: number density ~ r^-3 in a piece.
// Upper tails are drawn by their mirror images: differences of probabilities near 1
// would cancel.
//
// Draws, with u uniform on [0, 1) and a = 1 - exponent:
//     power law   r = low exp(log1p(u expm1(a ln(high / low))) / a),
//                 a = 0:  r = low (high / low)^u,
//     normal      r = mean + deviation Phi^-1(P_low + (P_high - P_low) u),
//     two_mode    second radius with share s m_1 / (s m_1 + (1 - s) m_2), m ~ r^3.
#include "sizes.h"

#include "basics/memory.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

// ---- building blocks ----------------------------------------------------------------

// Integral of r^-exponent from LOW to HIGH, times LOW^(exponent - 1): no unit.
static double power_integral(double low, double high, double exponent)
{
    const double rise = (1 - exponent) * log(high / low);
    return rise == 0 ? log(high / low) : expm1(rise) / (1 - exponent);
}

// Draws from a density ~ r^-exponent between LOW and HIGH, by its inverse.
static double draw_power(double low, double high, double exponent, gsl_rng *random)
{
    const double share = gsl_rng_uniform(random), span = log(high / low);
    const double rise = (1 - exponent) * span;
    const double along =
        rise == 0 ? share * span : log1p(share * expm1(rise)) / (1 - exponent);
    return fmin(fmax(low * exp(along), low), high);
}

// Probability of a standard normal between LOW and HIGH.
static double normal_share(double low, double high)
{
    if (low > 0) return normal_share(-high, -low);
    return gsl_cdf_ugaussian_P(high) - gsl_cdf_ugaussian_P(low);
}

static double draw_normal(double low, double high, gsl_rng *random)
{
    if (low > 0) return -draw_normal(-high, -low, random);
    const double from = gsl_cdf_ugaussian_P(low), to = gsl_cdf_ugaussian_P(high);
    const double share = from + (to - from) * gsl_rng_uniform_pos(random);
    return fmin(fmax(gsl_cdf_ugaussian_Pinv(share), low), high);
}

static int draw_piece(const struct sizes *sizes, gsl_rng *random)
{
    if (sizes->n_piece == 1) return 0;
    const double at = gsl_rng_uniform(random) * sizes->cumulative[sizes->n_piece - 1];
    int piece = 0;
    while (piece < sizes->n_piece - 1 && sizes->cumulative[piece] <= at)
        piece++;
    return piece;
}

// ---- from the user's parameters -----------------------------------------------------

static enum status check_range(const struct sizes *sizes, struct reason *reason)
{
    if (!(sizes->smallest > 0))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.sizes.smallest: must be given, for this distribution");
    if (isnan(sizes->largest))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.sizes.largest: must be given, for this distribution");
    if (!(sizes->smallest < sizes->largest))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.sizes.largest: must be above the smallest radius, %g m, "
                      "got %g",
                      sizes->smallest, sizes->largest);
    return STATUS_OK;
}

static enum status prepare_power(const struct size_parameters *parameters, double own,
                                 struct sizes *sizes, struct reason *reason)
{
    const enum status status = check_range(sizes, reason);
    if (status) return status;
    sizes->exponent = own + (parameters->by == SHARE_OF_MASS ? 3 : 0);
    sizes->n_piece = 1;
    sizes->edge[0] = sizes->smallest;
    sizes->edge[1] = sizes->largest;
    return STATUS_OK;
}

// By mass the density exp(-(r - mean)^2 / 2 s^2) / r^3 has no closed inverse. In pieces
// within which r^3 grows little it is a truncated normal thinned by (low / r)^3.
static enum status prepare_normal(const struct size_parameters *parameters,
                                  struct sizes *sizes, struct reason *reason)
{
    const double spread = parameters->spread;
    if (isnan(sizes->smallest)) sizes->smallest = 0.1 * parameters->radius;
    if (isnan(sizes->largest)) sizes->largest = (1 + 5 * spread) * parameters->radius;
    const enum status status = check_range(sizes, reason);
    if (status) return status;
    sizes->mean = parameters->radius;
    sizes->deviation = spread * parameters->radius;
    sizes->thinned = parameters->by == SHARE_OF_MASS;
    const double span = log(sizes->largest / sizes->smallest);
    sizes->n_piece = sizes->thinned ? (int)fmin(64, ceil(span / log(1.1))) : 1;
    double total = 0;
    for (int k = 0; k <= sizes->n_piece; k++)
        sizes->edge[k] = sizes->smallest * exp(span * k / sizes->n_piece);
    sizes->edge[sizes->n_piece] = sizes->largest;
    for (int k = 0; k < sizes->n_piece; k++) {
        const double share =
            normal_share((sizes->edge[k] - sizes->mean) / sizes->deviation,
                         (sizes->edge[k + 1] - sizes->mean) / sizes->deviation);
        total += share * pow(sizes->smallest / sizes->edge[k], 3);
        sizes->cumulative[k] = total;
    }
    if (!(total > 0))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.sizes.smallest: must leave something of the distribution");
    return STATUS_OK;
}

// A lognormal over r^3 is a lognormal again, moved by three variances.
static enum status prepare_lognormal(const struct size_parameters *parameters,
                                     struct sizes *sizes, struct reason *reason)
{
    const double variance = log1p(parameters->spread * parameters->spread);
    const double deviation = sqrt(variance), mean = -variance / 2;
    sizes->radius = parameters->radius;
    if (isnan(sizes->smallest))
        sizes->smallest = sizes->radius * exp(mean - 5 * deviation);
    if (isnan(sizes->largest))
        sizes->largest = sizes->radius * exp(mean + 5 * deviation);
    const enum status status = check_range(sizes, reason);
    if (status) return status;
    sizes->deviation = deviation;
    sizes->mean = mean - (parameters->by == SHARE_OF_MASS ? 3 * variance : 0);
    const double low = (log(sizes->smallest / sizes->radius) - sizes->mean) / deviation;
    const double high = (log(sizes->largest / sizes->radius) - sizes->mean) / deviation;
    if (!(normal_share(low, high) > 0))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.sizes.smallest: must leave something of the distribution");
    return STATUS_OK;
}

static enum status prepare_two_mode(const struct size_parameters *parameters,
                                    struct sizes *sizes, struct reason *reason)
{
    if (isnan(parameters->second_radius))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.sizes.second_radius: must be given, for two_mode");
    const double share = parameters->second_share;
    const double ratio = parameters->second_radius / parameters->radius;
    sizes->radius = parameters->radius;
    sizes->second_radius = parameters->second_radius;
    sizes->second_share = share;
    if (parameters->by == SHARE_OF_MASS)
        sizes->second_share = share / (share + (1 - share) * ratio * ratio * ratio);
    sizes->smallest = fmin(sizes->radius, sizes->second_radius);
    sizes->largest = fmax(sizes->radius, sizes->second_radius);
    return STATUS_OK;
}

static enum status check_sieve(const struct number_list *radii,
                               const struct number_list *passing, struct reason *reason)
{
    if (radii->count < 2 || radii->count != passing->count)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.sizes.sieve.passing: must be as many shares as "
                      "pack.sizes.sieve.radii, two or more, got %d of %d",
                      passing->count, radii->count);
    for (int k = 1; k < radii->count; k++) {
        if (!(radii->value[k - 1] < radii->value[k]))
            return refuse(reason, STATUS_BAD_DATA,
                          "pack.sizes.sieve.radii: must rise from one to the next, got "
                          "%g after %g",
                          radii->value[k], radii->value[k - 1]);
        if (!(passing->value[k - 1] <= passing->value[k]))
            return refuse(reason, STATUS_BAD_DATA,
                          "pack.sizes.sieve.passing: must not fall from one to the "
                          "next, got %g after %g",
                          passing->value[k], passing->value[k - 1]);
    }
    const double first = passing->value[0], last = passing->value[passing->count - 1];
    if (first != 0 || last != 1)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.sizes.sieve.passing: must go from 0 to 1, got %g to %g",
                      first, last);
    return STATUS_OK;
}

// Linear in between: the density is even from each radius to the next, so by mass the
// number falls as r^-3 there.
static enum status prepare_sieve(const struct size_parameters *parameters,
                                 struct sizes *sizes, struct reason *reason)
{
    const struct number_list *radii = &parameters->sieve_radii;
    const struct number_list *passing = &parameters->sieve_passing;
    const enum status status = check_sieve(radii, passing, reason);
    if (status) return status;
    sizes->exponent = parameters->by == SHARE_OF_MASS ? 3 : 0;
    sizes->n_piece = radii->count - 1;
    double total = 0;
    for (int k = 0; k < sizes->n_piece; k++) {
        const double low = radii->value[k], high = radii->value[k + 1];
        // the mean of (first radius / r)^exponent over the piece
        const double mean = power_integral(low, high, sizes->exponent) * low /
                            (high - low) * pow(radii->value[0] / low, sizes->exponent);
        total += (passing->value[k + 1] - passing->value[k]) * mean;
        sizes->edge[k] = low;
        sizes->edge[k + 1] = high;
        sizes->cumulative[k] = total;
    }
    sizes->smallest = radii->value[0];
    sizes->largest = radii->value[radii->count - 1];
    return STATUS_OK;
}

enum status sizes_prepare(const struct size_parameters *parameters, struct sizes *sizes,
                          struct reason *reason)
{
    *sizes = (struct sizes){.distribution = parameters->distribution,
                            .smallest = parameters->smallest,
                            .largest = parameters->largest,
                            .radius = parameters->radius};
    switch ((enum size_distribution)parameters->distribution) {
    case SIZES_ONE:
        sizes->smallest = sizes->largest = parameters->radius;
        return STATUS_OK;
    case SIZES_UNIFORM:
        return prepare_power(parameters, 0, sizes, reason);
    case SIZES_POWER:
        return prepare_power(parameters, parameters->exponent, sizes, reason);
    case SIZES_NORMAL:
        return prepare_normal(parameters, sizes, reason);
    case SIZES_LOGNORMAL:
        return prepare_lognormal(parameters, sizes, reason);
    case SIZES_TWO_MODE:
        return prepare_two_mode(parameters, sizes, reason);
    case SIZES_SIEVE:
        return prepare_sieve(parameters, sizes, reason);
    }
    return STATUS_INTERNAL;
}

void sizes_scale(struct sizes *sizes, double factor)
{
    sizes->smallest *= factor;
    sizes->largest *= factor;
    sizes->radius *= factor;
    sizes->second_radius *= factor;
    for (int k = 0; k <= sizes->n_piece; k++)
        sizes->edge[k] *= factor;
    if (sizes->distribution != SIZES_NORMAL) return; // otherwise of ln(r / radius)
    sizes->mean *= factor;
    sizes->deviation *= factor;
}

// ---- drawing ------------------------------------------------------------------------

static double draw_from_normal(const struct sizes *sizes, gsl_rng *random)
{
    for (;;) {
        const int k = draw_piece(sizes, random);
        const double low = sizes->edge[k], high = sizes->edge[k + 1];
        const double from = (low - sizes->mean) / sizes->deviation;
        const double to = (high - sizes->mean) / sizes->deviation;
        const double radius = fmin(
            fmax(sizes->mean + sizes->deviation * draw_normal(from, to, random), low),
            high);
        if (!sizes->thinned || gsl_rng_uniform(random) < pow(low / radius, 3))
            return radius;
    }
}

static double draw_from_lognormal(const struct sizes *sizes, gsl_rng *random)
{
    const double low = log(sizes->smallest / sizes->radius);
    const double high = log(sizes->largest / sizes->radius);
    const double from = (low - sizes->mean) / sizes->deviation;
    const double to = (high - sizes->mean) / sizes->deviation;
    const double at = sizes->mean + sizes->deviation * draw_normal(from, to, random);
    return fmin(fmax(sizes->radius * exp(at), sizes->smallest), sizes->largest);
}

double sizes_draw(const struct sizes *sizes, gsl_rng *random)
{
    int piece;
    switch ((enum size_distribution)sizes->distribution) {
    case SIZES_ONE:
        break;
    case SIZES_TWO_MODE:
        return gsl_rng_uniform(random) < sizes->second_share ? sizes->second_radius
                                                             : sizes->radius;
    case SIZES_NORMAL:
        return draw_from_normal(sizes, random);
    case SIZES_LOGNORMAL:
        return draw_from_lognormal(sizes, random);
    case SIZES_UNIFORM:
    case SIZES_POWER:
    case SIZES_SIEVE:
        piece = draw_piece(sizes, random);
        return draw_power(sizes->edge[piece], sizes->edge[piece + 1], sizes->exponent,
                          random);
    }
    return sizes->radius;
}

double *sizes_draw_many(const struct sizes *sizes, int n, gsl_rng *random)
{
    double *radius = NEW_ARRAY(double, n);
    for (int i = 0; i < n; i++)
        radius[i] = sizes_draw(sizes, random);
    return radius;
}
