// SPDX-License-Identifier: GPL-3.0-or-later
// Forces from a table, one by one or in batches; table_layout.h has the formulas. A
// batch goes step by step through all of its bridges, in vectors of four: one force
// alone is a long chain of roots, divisions and loads, of which a processor can overlap
// many. Batches and single forces have the same bytes: both sum their terms in the same
// order.
#include "bridges/table_layout.h"

#include <stdlib.h>

double bridge_table_force(const struct bridge_table *table, double volume, double gap)
{
    const struct place at = place_of(table, volume, gap);
    const float4 term = terms_of(table->force[at.patch][at.place], at.u, at.w);
    return at.scale * (double)((term[0] + term[1]) + (term[2] + term[3]));
}

// Sums the four terms of four forces, in the same order as above.
static inline float4 sum_terms(float4 a, float4 b, float4 c, float4 d)
{
    const float4 first = __builtin_shufflevector(a, b, 0, 2, 4, 6) +
                         __builtin_shufflevector(a, b, 1, 3, 5, 7);
    const float4 last = __builtin_shufflevector(c, d, 0, 2, 4, 6) +
                        __builtin_shufflevector(c, d, 1, 3, 5, 7);
    return __builtin_shufflevector(first, last, 0, 2, 4, 6) +
           __builtin_shufflevector(first, last, 1, 3, 5, 7);
}

// Number m of row n becomes number n of row m.
static inline void transpose(double4 row[4])
{
    const double4 a = __builtin_shufflevector(row[0], row[1], 0, 4, 2, 6),
                  b = __builtin_shufflevector(row[0], row[1], 1, 5, 3, 7),
                  c = __builtin_shufflevector(row[2], row[3], 0, 4, 2, 6),
                  d = __builtin_shufflevector(row[2], row[3], 1, 5, 3, 7);
    row[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
    row[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    row[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
    row[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

static inline double4 smaller(double4 a, double4 b)
{
    const mask4 is = a < b;
    return (double4)((is & (mask4)a) | (~is & (mask4)b));
}

// Batches of 64, four by four, as place_volume and place_of do it for one.
enum { BATCH = 64 };
struct places {
    double u[BATCH], rest[BATCH], shrink[BATCH], zeta[BATCH], scale[BATCH];
    int64_t patch[BATCH];
    int row[BATCH];
    float across[BATCH], w[BATCH];
};

static inline void place_volumes(const double *volume, struct places *at)
{
    const double4 zero = {0}, most = zero + BRIDGE_TABLE_MOST * (1 - 0x1p-53);
    for (int k = 0; k < BATCH; k += 4) {
        const double4 v = smaller(
            -smaller(-load_unaligned(&volume[k]), zero - BRIDGE_TABLE_LEAST), most);
        const mask4 bits = (mask4)v, patch = (bits >> 49) - LEAST_BITS;
        store_unaligned(
            &at->u[k],
            2 * (double4)((bits & 0x1ffffffffffff) << 3 | 0x3ff0000000000000) - 3);
        memcpy(&at->patch[k], &patch, sizeof patch);
    }
}

// 1 - a/A and 1/(1 + a/C).
static inline void stretch(const struct bridge_table *table, const double *gap,
                           struct places *at)
{
    const double4 zero = {0};
    for (int k = 0; k < BATCH; k += 4) {
        double4 row[8];
        for (int n = 0; n < 4; n++) {
            const struct volume_patch *patch = &table->volume[at->patch[k + n]];
            row[n] = load_unaligned(patch->turning);
            row[4 + n] = load_unaligned(patch->turning + 4);
        }
        transpose(row);
        transpose(row + 4);
        const double4 a = -smaller(-load_unaligned(&gap[k]), zero),
                      u = load_unaligned(&at->u[k]);
        store_unaligned(&at->rest[k], 1 - a * POLYNOMIAL(row, u));
        store_unaligned(&at->shrink[k], 1 / (1 + a * row[6]));
    }
}

static inline void place_along(struct places *at)
{
    const double4 zero = {0};
    for (int k = 0; k < BATCH; k += 4) {
        const double4 rest = load_unaligned(&at->rest[k]),
                      shrink = load_unaligned(&at->shrink[k]);
        const double4 zeta = square_root(-smaller(-rest, zero) * shrink),
                      wide = WIDE * zeta;
        const double4 x = wide + smaller(wide, zero + NARROW);
        const int4 place =
            __builtin_convertvector(smaller(x, zero + (PLACES - 1)), int4);
        const float4 across =
            __builtin_convertvector(load_unaligned(&at->u[k]), float4);
        const float4 w = __builtin_convertvector(
            2 * (x - __builtin_convertvector(place, double4)) - 1, float4);
        store_unaligned(&at->zeta[k], zeta);
        store_unaligned(&at->scale[k],
                        (double4)((mask4)(shrink * shrink) & (rest > 0)));
        memcpy(&at->row[k], &place, sizeof place);
        memcpy(&at->across[k], &across, sizeof across);
        memcpy(&at->w[k], &w, sizeof w);
    }
}

static inline void rupture_broken(const struct bridge_table *table, struct places *at)
{
    for (int k = 0; k < BATCH; k++) {
        const struct volume_place place = {(int)at->patch[k], at->u[k]};
        if (at->zeta[k] < end_at(table, place)) at->scale[k] = 0;
    }
}

static void batch_forces(const struct bridge_table *table, const double *volume,
                         const double *gap, double *force)
{
    struct places at;
    place_volumes(volume, &at);
    stretch(table, gap, &at);
    place_along(&at);
    if (table->breaks) rupture_broken(table, &at);
    for (int k = 0; k < BATCH; k += 4) {
        float4 term[4];
        for (int n = 0; n < 4; n++)
            term[n] = terms_of(table->force[at.patch[k + n]][at.row[k + n]],
                               at.across[k + n], at.w[k + n]);
        const float4 sum = sum_terms(term[0], term[1], term[2], term[3]);
        store_unaligned(&force[k], load_unaligned(&at.scale[k]) *
                                       __builtin_convertvector(sum, double4));
    }
}

void bridge_table_forces(const struct bridge_table *table, int count,
                         const double *volume, const double *gap, double *force)
{
    int k = 0;
    for (; k + BATCH <= count; k += BATCH)
        batch_forces(table, &volume[k], &gap[k], &force[k]);
    for (; k < count; k++)
        force[k] = bridge_table_force(table, volume[k], gap[k]);
}

double bridge_table_rupture(const struct bridge_table *table, double volume)
{
    const struct volume_place at = place_volume(volume);
    const struct volume_patch *patch = &table->volume[at.patch];
    const double end = table->breaks ? fmax(end_at(table, at), 0) : 0;
    return (1 - end * end) /
           (POLYNOMIAL(patch->turning, at.u) + end * end * patch->steepness);
}

double bridge_table_error(const struct bridge_table *table)
{
    return table->error;
}

void bridge_table_free(struct bridge_table *table)
{
    free(table);
}
