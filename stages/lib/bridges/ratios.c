// SPDX-License-Identifier: GPL-3.0-or-later
// Forces between grains of many sizes, by interpolation between tables at seventeen
// ratios of radii. For asymmetry s, volume V and gap a (ratios_layout.h):
//     weights  = Lagrange's polynomials at s through the six nearest tables,
//     1/A      = sum of weights times 1/A of each table,
//     zeta^2   = (1 - a/A) / (1 + a/C),
//     F        = (1 + a/C)^-2 sum of weights times the tables' patches at the same
//     zeta.
// A volume outside the tables takes the nearest one at the same zeta, with A scaling as
// V^(1/3) and C as V^(1/2). Trap: asymmetry 0 has a table of its own, as equal grains
// may rupture by a break of symmetry.
#include "bridges/ratios_layout.h"

#include <stdlib.h>

double bridge_asymmetry(double first_radius, double second_radius)
{
    if (isinf(first_radius) || isinf(second_radius)) return 1;
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

// The six tables of a pair, from FIRST on, and their weights.
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

// ---- volumes that are tabulated -----------------------------------------------------

static double unequal_force(const struct bridge_ratios *ratios, double asymmetry,
                            double volume, double gap)
{
    const struct blend blend = blend_at(asymmetry, interval_of(asymmetry));
    const struct volume_place at = place_volume(volume);
    const struct ratio_patch *patch = &ratios->patch[at.patch / IN_HALF];
    const double u = u_in_half(at), rest = 1 - gap * inverse_at(patch, &blend, u);
    if (!(rest > 0)) return 0;
    const double shrink = 1 / (1 + gap * patch->steepness);
    const double x = along(WIDE * sqrt(rest * shrink));
    const int place = x < PLACES ? (int)x : PLACES - 1;
    float8 row[3] = {{0}, {0}, {0}};
    for (int k = 0; k < STENCIL; k++) {
        const float weight = (float)blend.weight[k];
        const float8 *from = patch->force[place][blend.first + k];
        for (int i = 0; i < 3; i++)
            row[i] += weight * from[i];
    }
    row[1] += (float)(u * u) * row[2];
    const float4 term = terms_of(row, (float)u, (float)(2 * (x - place) - 1));
    return shrink * shrink * (double)((term[0] + term[1]) + (term[2] + term[3]));
}

static double tabulated_force(const struct bridge_ratios *ratios, double asymmetry,
                              double volume, double gap)
{
    return asymmetry > 0 ? unequal_force(ratios, asymmetry, volume, gap)
                         : bridge_table_force(ratios->equal, volume, gap);
}

static double tabulated_rupture(const struct bridge_ratios *ratios, double asymmetry,
                                double volume)
{
    if (!(asymmetry > 0)) return bridge_table_rupture(ratios->equal, volume);
    const struct blend blend = blend_at(asymmetry, interval_of(asymmetry));
    const struct volume_place at = place_volume(volume);
    return 1 / inverse_at(&ratios->patch[at.patch / IN_HALF], &blend, u_in_half(at));
}

// ---- any volume ---------------------------------------------------------------------

// The nearest volume that is tabulated.
static double nearest_volume(const struct bridge_ratios *ratios, double asymmetry,
                             double volume)
{
    const struct range range =
        asymmetry > 0 ? ratios->range[interval_of(asymmetry)] : ratios->equal_range;
    const int patch = place_volume(volume).patch;
    if (patch < range.first || volume < BRIDGE_TABLE_LEAST)
        return patch_volume(range.first, -1);
    if (patch > range.last || volume > BRIDGE_TABLE_MOST)
        return patch_volume(range.last, 1 - 1e-9); // not the first of the next
    return volume;
}

// Force for a volume that is not tabulated, from the nearest one at the same zeta, with
// A as the cube root of the volume and C as its square root.
static double other_force(const struct bridge_ratios *ratios, double asymmetry,
                          double volume, double nearest, double gap)
{
    const double inverse = 1 / tabulated_rupture(ratios, asymmetry, nearest);
    const double steepness = 1 / (1.2 * sqrt(nearest));
    const double spread = 1 + gap * steepness * sqrt(nearest / volume);
    const double rest = 1 - gap * inverse * cbrt(nearest / volume);
    if (!(rest > 0)) return 0;
    const double square = rest / spread; // of zeta
    const double there = (1 - square) / (inverse + square * steepness);
    const double ratio = (1 + there * steepness) / spread;
    return ratio * ratio * tabulated_force(ratios, asymmetry, nearest, there);
}

void bridge_ratios_forces(const struct bridge_ratios *ratios, int count,
                          const double *asymmetry, const double *volume,
                          const double *gap, double *force)
{
    if (ratios->as_it_is) {
        bridge_table_forces(ratios->equal, count, volume, gap, force);
        return;
    }
    for (int k = 0; k < count; k++) {
        const double s = asymmetry[k], v = volume[k], a = fmax(gap[k], 0);
        const double nearest = nearest_volume(ratios, s, v);
        force[k] = nearest < v || nearest > v ? other_force(ratios, s, v, nearest, a)
                                              : tabulated_force(ratios, s, v, a);
    }
}

double bridge_ratios_rupture(const struct bridge_ratios *ratios, double asymmetry,
                             double volume)
{
    const double nearest = nearest_volume(ratios, asymmetry, volume);
    return tabulated_rupture(ratios, asymmetry, nearest) * cbrt(volume / nearest);
}
