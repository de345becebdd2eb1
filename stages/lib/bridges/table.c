// SPDX-License-Identifier: GPL-3.0-or-later
// With the rupture distance A and a length C of 1.2 sqrt(volume),
//     zeta = sqrt((1 - a/A)/(1 + a/C))
// runs from 1 at contact to 0 at rupture. It spreads both places where the force is
// steep: next to contact, where it changes over sqrt(volume), and next to rupture,
// where it goes with the root of what is left. Then F (1 + a/C)^2 is a smooth number of
// order one, which bicubic patches in volume and zeta hold.
//
// The patches in volume are quarters of octaves, found from the bits of the number: a
// force takes one division and one root, no logarithm and no search.
#include "bridges/table.h"

#include "basics/memory.h"
#include "bridges/equilibrium.h"

#include <math.h>
#include <stdalign.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { OCTAVES = 30, QUARTERS = 4, VOLUMES = OCTAVES * QUARTERS, PLACES = 96 };
enum { RUPTURE_ORDER = 7, ORDER = 4 }; // coefficients of rupture and of forces

typedef float eight __attribute__((vector_size(32)));
typedef float four __attribute__((vector_size(16)));

// Of the least volume, those above the second of the fraction.
static const int least_bits = (1023 - OCTAVES) * QUARTERS;

// For one patch of volumes, with u from -1 to 1 across it.
struct volume_patch {
    double rupture[RUPTURE_ORDER]; // 1/A as a polynomial in u
    double steepness;              // 1/C
};

struct bridge_table {
    double error;
    struct volume_patch volume[VOLUMES];
    // Coefficients of u^i w^j, w from -1 to 1 across the place: i = 0 and 1, 2 and 3.
    alignas(64) eight force[VOLUMES][PLACES][2];
};

// ---- reading -----------------------------------------------------------------------

struct volume_place {
    int patch;
    double u;
};

static inline struct volume_place place_volume(double volume)
{
    const double most = BRIDGE_TABLE_MOST * (1 - 0x1p-53);
    volume = volume < BRIDGE_TABLE_LEAST ? BRIDGE_TABLE_LEAST : volume;
    volume = volume > most ? most : volume;
    uint64_t bits;
    memcpy(&bits, &volume, sizeof bits);
    const uint64_t within = (bits & 0x3ffffffffffff) << 2 | 0x3ff0000000000000;
    double fraction; // 1 to 2
    memcpy(&fraction, &within, sizeof fraction);
    return (struct volume_place){(int)(bits >> 50) - least_bits, 2 * fraction - 3};
}

static inline double rupture_at(const struct volume_patch *patch, double u)
{
    const double *c = patch->rupture, square = u * u;
    return (c[0] + u * c[1]) + square * (c[2] + u * c[3]) +
           square * square * ((c[4] + u * c[5]) + square * c[6]);
}

struct place {
    int patch, place;
    float u, w;
    double scale; // (1 + a/C)^-2; 0 beyond rupture
};

static inline struct place place_of(const struct bridge_table *table, double volume,
                                    double gap)
{
    const struct volume_place at = place_volume(volume);
    const struct volume_patch *patch = &table->volume[at.patch];
    gap = gap > 0 ? gap : 0;
    const double rest = 1 - gap * rupture_at(patch, at.u), left = rest > 0 ? rest : 0;
    const double shrink = 1 / (1 + gap * patch->steepness);
    const double zeta = PLACES * sqrt(left * shrink);
    const int whole = (int)zeta, place = whole < PLACES ? whole : PLACES - 1;
    return (struct place){at.patch, place, (float)at.u, (float)(2 * (zeta - place) - 1),
                          rest > 0 ? shrink * shrink : 0};
}

// The terms of a patch's polynomial, still to be added up.
static inline four terms_of(const eight row[2], float u, float w)
{
    const float square = w * w;
    const eight rows = row[0] + u * u * row[1];
    const four low = {rows[0], rows[1], rows[2], rows[3]};
    const four high = {rows[4], rows[5], rows[6], rows[7]};
    const four powers = {1, w, square, w * square};
    return (low + u * high) * powers;
}

double bridge_table_force(const struct bridge_table *table, double volume, double gap)
{
    const struct place at = place_of(table, volume, gap);
    const four term = terms_of(table->force[at.patch][at.place], at.u, at.w);
    return at.scale * (double)((term[0] + term[1]) + (term[2] + term[3]));
}

// Sums the four terms of four forces, in the same order as above.
static inline four sum_terms(four a, four b, four c, four d)
{
    typedef int places __attribute__((vector_size(16)));
    const places even = {0, 2, 4, 6}, odd = {1, 3, 5, 7};
    const four first = __builtin_shuffle(a, b, even) + __builtin_shuffle(a, b, odd);
    const four last = __builtin_shuffle(c, d, even) + __builtin_shuffle(c, d, odd);
    return __builtin_shuffle(first, last, even) + __builtin_shuffle(first, last, odd);
}

// Places of many, number by number as place_of has it, in loops without branches that
// the compiler turns into vectors.
enum { BATCH = 64 };
struct places {
    alignas(64) double u[BATCH], scale[BATCH];
    alignas(64) float across[BATCH], w[BATCH];
    alignas(64) int patch[BATCH], row[BATCH];
};

static inline void place_batch(const struct bridge_table *table, int count,
                               const double *volume, const double *gap,
                               struct places *at)
{
    for (int k = 0; k < count; k++) {
        const struct volume_place place = place_volume(volume[k]);
        at->patch[k] = place.patch;
        at->u[k] = place.u;
    }
#pragma omp simd
    for (int k = 0; k < count; k++) {
        const struct volume_patch *patch = &table->volume[at->patch[k]];
        const double a = gap[k] > 0 ? gap[k] : 0,
                     rest = 1 - a * rupture_at(patch, at->u[k]);
        const double left = rest > 0 ? rest : 0;
        const double shrink = 1 / (1 + a * patch->steepness);
        const double zeta = PLACES * sqrt(left * shrink);
        const int whole = (int)zeta, place = whole < PLACES ? whole : PLACES - 1;
        at->row[k] = at->patch[k] * PLACES + place;
        at->across[k] = (float)at->u[k];
        at->w[k] = (float)(2 * (zeta - place) - 1);
        at->scale[k] = rest > 0 ? shrink * shrink : 0;
    }
}

static void batch_forces(const struct bridge_table *table, int count,
                         const double *volume, const double *gap, double *force)
{
    struct places at;
    place_batch(table, count, volume, gap, &at);
    const eight(*rows)[2] = table->force[0];
    for (int k = 0; k + 4 <= count; k += 4) {
        four term[4];
        for (int n = 0; n < 4; n++)
            term[n] = terms_of(rows[at.row[k + n]], at.across[k + n], at.w[k + n]);
        const four sum = sum_terms(term[0], term[1], term[2], term[3]);
        for (int n = 0; n < 4; n++)
            force[k + n] = at.scale[k + n] * (double)sum[n];
    }
}

void bridge_table_forces(const struct bridge_table *table, int count,
                         const double *volume, const double *gap, double *force)
{
    int k = 0;
    for (; k + BATCH <= count; k += BATCH)
        batch_forces(table, BATCH, &volume[k], &gap[k], &force[k]);
    for (; k < count; k++)
        force[k] = bridge_table_force(table, volume[k], gap[k]);
}

double bridge_table_rupture(const struct bridge_table *table, double volume)
{
    const struct volume_place at = place_volume(volume);
    return 1 / rupture_at(&table->volume[at.patch], at.u);
}

// ---- making ------------------------------------------------------------------------

// Chebyshev's nodes and polynomials: node K of COUNT, from 1 down to -1.
static double node(int k, int count)
{
    return cos(M_PI * (k + 0.5) / count);
}

// Interpolates VALUE at COUNT nodes; gives the coefficients of powers.
static void fit(const double *value, int count, double *power)
{
    static const double powers[RUPTURE_ORDER][RUPTURE_ORDER] = {
        {1},
        {0, 1},
        {-1, 0, 2},
        {0, -3, 0, 4},
        {1, 0, -8, 0, 8},
        {0, 5, 0, -20, 0, 16},
        {-1, 0, 18, 0, -48, 0, 32}};
    memset(power, 0, (size_t)count * sizeof *power);
    for (int n = 0; n < count; n++) {
        double sum = 0;
        for (int k = 0; k < count; k++)
            sum += value[k] * cos(M_PI * n * (k + 0.5) / count);
        sum *= (n ? 2.0 : 1.0) / count;
        for (int p = 0; p <= n; p++)
            power[p] += sum * powers[n][p];
    }
}

static double patch_volume(int patch, double u)
{
    const double octave = ldexp(BRIDGE_TABLE_LEAST, patch / QUARTERS);
    return octave * (1 + (patch % QUARTERS + 0.5 * (u + 1)) / QUARTERS);
}

// zeta of node J of a place, from 0 at rupture up.
static double zeta_at(int place, double w)
{
    return (place + 0.5 * (w + 1)) / PLACES;
}

enum { SAMPLES = PLACES * ORDER };

// F (1 + a/C)^2 at all places' nodes for one volume.
static enum status sample(const struct bodies *bodies, double volume,
                          const struct volume_patch *patch, double u,
                          double values[SAMPLES])
{
    const double inverse = rupture_at(patch, u), steepness = patch->steepness;
    double gap[SAMPLES];
    struct equilibrium found[SAMPLES];
    for (int s = 0; s < SAMPLES; s++) { // from contact on: gaps rise
        const double zeta = zeta_at(PLACES - 1 - s / ORDER, node(s % ORDER, ORDER));
        gap[s] = (1 - zeta * zeta) / (inverse + zeta * zeta * steepness);
    }
    const enum status status = follow_branch(bodies, volume, SAMPLES, gap, found);
    if (status) return status;
    for (int s = 0; s < SAMPLES; s++) {
        const double stretch = 1 + gap[s] * steepness;
        const int place = PLACES - 1 - s / ORDER;
        values[place * ORDER + s % ORDER] =
            2 * M_PI * arc_force(bodies, &found[s].arc) * stretch * stretch;
    }
    return STATUS_OK;
}

static enum status fit_rupture(const struct bodies *bodies, int patch,
                               struct volume_patch *at)
{
    double inverse[RUPTURE_ORDER];
    for (int k = 0; k < RUPTURE_ORDER; k++) {
        struct equilibrium last;
        const double volume = patch_volume(patch, node(k, RUPTURE_ORDER));
        const enum status status = find_rupture(bodies, volume, &last);
        if (status) return status;
        inverse[k] = 1 / last.gap;
    }
    fit(inverse, RUPTURE_ORDER, at->rupture);
    return STATUS_OK;
}

// Interpolates at ORDER by ORDER nodes.
static void fit_place(const double value[ORDER][SAMPLES], int place, eight row[2])
{
    double across[ORDER][ORDER], power[ORDER];
    for (int v = 0; v < ORDER; v++) {
        fit(&value[v][place * ORDER], ORDER, power);
        for (int j = 0; j < ORDER; j++)
            across[j][v] = power[j];
    }
    for (int j = 0; j < ORDER; j++) {
        fit(across[j], ORDER, power);
        for (int i = 0; i < ORDER; i++)
            row[i / 2][i % 2 * ORDER + j] = (float)power[i];
    }
}

static enum status fill_patch(const struct bodies *bodies, int patch,
                              struct bridge_table *table)
{
    struct volume_patch *at = &table->volume[patch];
    double value[ORDER][SAMPLES];
    at->steepness = 1 / (1.2 * sqrt(patch_volume(patch, 0)));
    enum status status = fit_rupture(bodies, patch, at);
    for (int v = 0; v < ORDER && !status; v++) {
        const double u = node(v, ORDER);
        status = sample(bodies, patch_volume(patch, u), at, u, value[v]);
    }
    for (int place = 0; place < PLACES && !status; place++)
        fit_place(value, place, table->force[patch][place]);
    return status;
}

// The largest error at places between the nodes, on the border of two patches.
static enum status measure(const struct bodies *bodies,
                           const struct bridge_table *table, int patch, double *error)
{
    enum { CHECKS = 2 * PLACES };
    const double volume = patch_volume(patch, -1);
    double gap[CHECKS];
    struct equilibrium found[CHECKS];
    const struct volume_patch *at = &table->volume[patch];
    for (int k = 0; k < CHECKS; k++) { // zeta from 1 down to half a place from 0
        const double zeta = 1 - (double)k / CHECKS, square = zeta * zeta;
        gap[k] = (1 - square) / (rupture_at(at, -1) + square * at->steepness);
    }
    const enum status status = follow_branch(bodies, volume, CHECKS, gap, found);
    if (status) return status;
    *error = 0;
    for (int k = 0; k < CHECKS; k++) {
        const double exact = 2 * M_PI * arc_force(bodies, &found[k].arc);
        const double ours = bridge_table_force(table, volume, gap[k]);
        const double least = BRIDGE_TABLE_FLOOR / (1 + gap[k] * at->steepness) /
                             (1 + gap[k] * at->steepness);
        *error = fmax(*error, fabs(ours - exact) / fmax(fabs(exact), least));
    }
    return STATUS_OK;
}

static enum status make_patch(const struct bodies *bodies, int patch,
                              struct bridge_table *table, double *error)
{
    const enum status status = fill_patch(bodies, patch, table);
    return status ? status : measure(bodies, table, patch, error);
}

enum status bridge_table_create(const double radius[2], const double contact_angle[2],
                                struct bridge_table **table, struct reason *reason)
{
    const double first = 1 / radius[0], second = 1 / radius[1];
    const double scale = 2 / (first + second);
    if (!(first >= 0 && second >= 0 && isfinite(scale)))
        return refuse(reason, STATUS_BAD_DATA, "no bridge between radii %g and %g",
                      radius[0], radius[1]);
    const struct bodies bodies = {{first * scale, second * scale},
                                  {contact_angle[0], contact_angle[1]}};
    struct bridge_table *made = aligned_alloc(64, sizeof *made);
    if (!made) return refuse(reason, STATUS_INTERNAL, "out of memory");
    *table = made;
    enum status status[VOLUMES];
    double error[VOLUMES];
#pragma omp parallel for schedule(dynamic)
    for (int patch = 0; patch < VOLUMES; patch++)
        status[patch] = make_patch(&bodies, patch, made, &error[patch]);
    made->error = 0;
    for (int patch = 0; patch < VOLUMES; patch++) {
        made->error = fmax(made->error, error[patch]);
        if (status[patch]) {
            free(made);
            return refuse(
                reason, STATUS_NOT_CONVERGED,
                "no table: a bridge of %g effective radii cubed was not solved",
                patch_volume(patch, 0));
        }
    }
    return STATUS_OK;
}

double bridge_table_error(const struct bridge_table *table)
{
    return table->error;
}

void bridge_table_free(struct bridge_table *table)
{
    free(table);
}
