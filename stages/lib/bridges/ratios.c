// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of bridges between grains of many sizes.
#include "bridges/ratios_layout.h"

#include <stdlib.h>

double bridge_asymmetry(double first_radius, double second_radius)
{
    const double rounding = 1e-12;
    const double apart = fabs(first_radius - second_radius);
    const double sum = first_radius + second_radius;
    return apart > rounding * sum ? cbrt(apart / sum) : 0;
}

void bridge_ratios_free(struct bridge_ratios *ratios)
{
    if (!ratios) return;
    free(ratios->equal);
    free(ratios->patch);
    free(ratios);
}

// Of a pair: six tables from FIRST on, and what each counts for.
struct blend {
    int first;
    double weight[STENCIL];
};

// Lagrange's polynomials at T from the first of the tables on.
static struct blend blend_at(double asymmetry, int interval)
{
    static const double scale[STENCIL] = {-1. / 120, 1. / 24,  -1. / 12,
                                          1. / 12,   -1. / 24, 1. / 120};
    struct blend blend = {.first = first_of_stencil(interval)};
    const double t = asymmetry * INTERVALS - blend.first;
    double below = 1;
    for (int k = 0; k < STENCIL; k++) {
        blend.weight[k] = scale[k] * below;
        below *= t - k;
    }
    double above = 1;
    for (int k = STENCIL - 1; k >= 0; k--) {
        blend.weight[k] *= above;
        above *= t - k;
    }
    return blend;
}

// Where a volume lies among the patches of RANGE; one outside is taken as the nearest,
// and SHRINK is what a gap is then multiplied by.
struct chosen {
    struct volume_place at;
    double volume, shrink;
};

static struct chosen choose_volume(struct range range, double volume)
{
    struct chosen chosen = {place_volume(volume), volume, 1};
    const bool is_less = chosen.at.patch < range.first || volume < BRIDGE_TABLE_LEAST;
    const bool is_more = chosen.at.patch > range.last || volume > BRIDGE_TABLE_MOST;
    if (!is_less && !is_more) return chosen;
    chosen.at.patch = is_less ? range.first : range.last;
    chosen.at.u = is_less ? -1 : 1 - 1e-9; // not the first of the next patch
    chosen.volume = patch_volume(chosen.at.patch, chosen.at.u);
    chosen.shrink = cbrt(chosen.volume / volume);
    return chosen;
}

static int interval_of(double asymmetry)
{
    return asymmetry < 1 ? (int)(asymmetry * INTERVALS) : INTERVALS - 1;
}

static double inverse_at(const struct ratio_patch *patch, const struct blend *blend,
                         double u)
{
    double sum = 0;
    for (int k = 0; k < STENCIL; k++)
        sum += blend->weight[k] * POLYNOMIAL(patch->inverse[blend->first + k], u);
    return sum;
}

// Between grains of unequal radii.
static double unequal_force(const struct bridge_ratios *ratios, double asymmetry,
                            double volume, double given_gap)
{
    const int interval = interval_of(asymmetry);
    const struct blend blend = blend_at(asymmetry, interval);
    const struct chosen chosen = choose_volume(ratios->range[interval], volume);
    const struct ratio_patch *patch = &ratios->patch[chosen.at.patch / IN_HALF];
    const double u = u_in_half(chosen.at);
    const double gap = fmax(given_gap, 0) * chosen.shrink;
    const double rest = 1 - gap * inverse_at(patch, &blend, u);
    if (!(rest > 0)) return 0;
    const double shrink = 1 / (1 + gap * patch->steepness);
    const double x = along(WIDE * sqrt(rest * shrink));
    const int place = x < PLACES ? (int)x : PLACES - 1;
    eight row[3] = {{0}, {0}, {0}};
    for (int k = 0; k < STENCIL; k++) {
        const float weight = (float)blend.weight[k];
        const eight *from = patch->force[place][blend.first + k];
        for (int i = 0; i < 3; i++)
            row[i] += weight * from[i];
    }
    row[1] += (float)(u * u) * row[2];
    const four term = terms_of(row, (float)u, (float)(2 * (x - place) - 1));
    return shrink * shrink * (double)((term[0] + term[1]) + (term[2] + term[3]));
}

static double equal_force(const struct bridge_ratios *ratios, double volume, double gap)
{
    const struct chosen chosen = choose_volume(ratios->equal_range, volume);
    return bridge_table_force(ratios->equal, chosen.volume, gap * chosen.shrink);
}

void bridge_ratios_forces(const struct bridge_ratios *ratios, int count,
                          const double *asymmetry, const double *volume,
                          const double *gap, double *force)
{
    if (ratios->as_it_is) {
        bridge_table_forces(ratios->equal, count, volume, gap, force);
        return;
    }
    for (int k = 0; k < count; k++)
        force[k] = asymmetry[k] > 0
                       ? unequal_force(ratios, asymmetry[k], volume[k], gap[k])
                       : equal_force(ratios, volume[k], gap[k]);
}

double bridge_ratios_rupture(const struct bridge_ratios *ratios, double asymmetry,
                             double volume)
{
    if (!(asymmetry > 0)) {
        const struct chosen chosen = choose_volume(ratios->equal_range, volume);
        return bridge_table_rupture(ratios->equal, chosen.volume) / chosen.shrink;
    }
    const int interval = interval_of(asymmetry);
    const struct blend blend = blend_at(asymmetry, interval);
    const struct chosen chosen = choose_volume(ratios->range[interval], volume);
    const struct ratio_patch *patch = &ratios->patch[chosen.at.patch / IN_HALF];
    return 1 / (inverse_at(patch, &blend, u_in_half(chosen.at)) * chosen.shrink);
}
