// SPDX-License-Identifier: GPL-3.0-or-later
// How a table of bridges is laid out; for the files that make and read it only.
//
// With the gap A of the turning point and a length C of 1.2 sqrt(volume),
//     zeta = sqrt((1 - a/A)/(1 + a/C))
// runs from 1 at contact to 0 at A. It resolves both places where the force is steep:
// near contact, where it changes over sqrt(volume), and near the turning point, where
// it changes as sqrt(1 - a/A). Then F (1 + a/C)^2 is a smooth number of order one,
// which bicubic patches in volume and zeta represent. Where symmetry breaks first the
// bridge ruptures before, at a zeta above 0; the table beyond is only for smoothness.
//
// The patches in volume are eighths of octaves, found from the bits of the number: a
// force takes one division and one root, no logarithm and no search.
//
// How a force is found, in code order:
//     u      where the volume lies in its patch (place_volume),
//     1/A    POLYNOMIAL of volume_patch.turning at u,   1/C = steepness,
//     zeta   sqrt((1 - a/A) / (1 + a/C)),  its place and w (along, place_of),
//     F      sum over i, j of c_ij u^i w^j  times  (1 + a/C)^-2   (terms_of).
// A table takes VOLUMES * PLACES * 64 bytes for the coefficients, a megabyte; they are
// floats, because the error of interpolation (bridge_table_error) is above theirs. One
// force reads two lines of the cache: a volume_patch and a pair of float8.
#pragma once

#include "basics/simd.h"
#include "bridges/table.h"

#include <math.h>
#include <stdalign.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

// Places in zeta: 1/64 wide, below 4/64 half of that.
enum { OCTAVES = 30, EIGHTHS = 8, VOLUMES = OCTAVES * EIGHTHS };
enum { WIDE = 64, NARROW = 4, PLACES = WIDE + NARROW };
enum { TURNING_ORDER = 6, ORDER = 4 }; // coefficients of 1/A, and of all else

// Patch bits (exponent, and the eighth of an octave) of the least volume.
static const int LEAST_BITS = (1023 - OCTAVES) * EIGHTHS;

// For one patch of volumes, with u from -1 to 1 across it; two quads. One line of the
// cache.
struct volume_patch {
    alignas(64) double turning[TURNING_ORDER]; // 1/A as a polynomial in u
    double steepness;                          // 1/C
    double unused;
};

// Volumes and gaps in effective radii and their cubes, forces in effective radius times
// surface tension. ERROR is the largest found when it was made, relative to the exact
// force.
struct bridge_table {
    double error;
    bool breaks;                // symmetry, somewhere
    double end[VOLUMES][ORDER]; // zeta at rupture, as a polynomial in u; below 0: 0
    struct volume_patch volume[VOLUMES];
    // Coefficients of u^i w^j, w from -1 to 1 across the place: i = 0 and 1, 2 and 3.
    alignas(64) float8 force[VOLUMES][PLACES][2];
};

// Which patch a volume is in, and where across it: u from -1 to 1.
struct volume_place {
    int patch;
    double u;
};

// The upper 15 bits of a double are its sign, exponent and the first three digits of
// the fraction: octave and eighth. The rest of the fraction, with the exponent of 1, is
// a number from 1 to 2. Volumes beyond the table count as its ends.
static inline struct volume_place place_volume(double volume)
{
    const double most = BRIDGE_TABLE_MOST * (1 - 0x1p-53);
    volume = volume < BRIDGE_TABLE_LEAST ? BRIDGE_TABLE_LEAST : volume;
    volume = volume > most ? most : volume;
    uint64_t bits;
    memcpy(&bits, &volume, sizeof bits);
    const uint64_t within = (bits & 0x1ffffffffffff) << 3 | 0x3ff0000000000000;
    double fraction; // 1 to 2
    memcpy(&fraction, &within, sizeof fraction);
    return (struct volume_place){(int)(bits >> 49) - LEAST_BITS, 2 * fraction - 3};
}

// The volume at U of a patch, from -1 to 1. The inverse of place_volume. PATCH counts
// from 0 to VOLUMES - 1.
static inline double patch_volume(int patch, double u)
{
    const double octave = ldexp(BRIDGE_TABLE_LEAST, patch / EIGHTHS);
    return octave * (1 + (patch % EIGHTHS + 0.5 * (u + 1)) / EIGHTHS);
}

#define POLYNOMIAL(c, u)                                                               \
    (((c)[0] + (u) * (c)[1]) + (u) * (u) * ((c)[2] + (u) * (c)[3]) +                   \
     (u) * (u) * ((u) * (u)) * ((c)[4] + (u) * (c)[5]))

// zeta at rupture in this patch: Horner in pairs, as the vector code adds. Compare zeta
// with it: below, the bridge has ruptured.
static inline double end_at(const struct bridge_table *table, struct volume_place at)
{
    const double *c = table->end[at.patch], u = at.u;
    return (c[0] + u * c[1]) + u * u * (c[2] + u * c[3]);
}

// Whether a patch has bridges that rupture by a break of symmetry.
static inline bool breaks_in(const double end[ORDER])
{
    bool breaks = false;
    for (int k = 0; k < ORDER; k++)
        breaks = breaks || fabs(end[k]) > 0;
    return breaks;
}

// How many places of zeta are below it, from zeta in the wide ones. Counts places from
// zeta = 0 up: NARROW of the wide ones are cut in two.
static inline double along(double wide)
{
    return wide + (wide < NARROW ? wide : NARROW);
}

// The terms of a patch's polynomial, still to be added up. Four floats, one for each
// power of w; their sum is F (1 + a/C)^2.
static inline float4 terms_of(const float8 row[2], float u, float w)
{
    const float square = w * w;
    const float8 rows = row[0] + u * u * row[1];
    const float4 low = {rows[0], rows[1], rows[2], rows[3]};
    const float4 high = {rows[4], rows[5], rows[6], rows[7]};
    const float4 powers = {1, w, square, w * square};
    return (low + u * high) * powers;
}

// U and W from -1 to 1.
struct place {
    int patch, place;
    float u, w;
    double scale; // (1 + a/C)^-2; 0 beyond rupture
};

// 1 - a/A falls below 0 beyond the turning point: no bridge there, whatever zeta.
static inline struct place place_of(const struct bridge_table *table, double volume,
                                    double gap)
{
    const struct volume_place at = place_volume(volume);
    const struct volume_patch *patch = &table->volume[at.patch];
    gap = gap > 0 ? gap : 0;
    const double rest = 1 - gap * POLYNOMIAL(patch->turning, at.u);
    const double left = rest > 0 ? rest : 0;
    const double shrink = 1 / (1 + gap * patch->steepness);
    const double zeta = sqrt(left * shrink), x = along(WIDE * zeta);
    const int whole = (int)x, place = whole < PLACES ? whole : PLACES - 1;
    const bool ruptured = !(rest > 0) || (table->breaks && zeta < end_at(table, at));
    return (struct place){at.patch, place, (float)at.u, (float)(2 * (x - place) - 1),
                          ruptured ? 0 : shrink * shrink};
}
