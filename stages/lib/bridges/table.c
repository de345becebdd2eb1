// SPDX-License-Identifier: GPL-3.0-or-later
// Forces from a table, one by one or many at once.
#include "bridges/table_layout.h"

#ifdef __AVX__
#include <immintrin.h>
#endif
#include <stdlib.h>

typedef double quad __attribute__((vector_size(32)));
typedef int64_t mask __attribute__((vector_size(32)));

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

// Number m of row n becomes number n of row m.
static inline void transpose(quad row[4])
{
    const mask even = {0, 4, 2, 6}, odd = {1, 5, 3, 7};
    const mask low = {0, 1, 4, 5}, high = {2, 3, 6, 7};
    const quad a = __builtin_shuffle(row[0], row[1], even),
               b = __builtin_shuffle(row[0], row[1], odd),
               c = __builtin_shuffle(row[2], row[3], even),
               d = __builtin_shuffle(row[2], row[3], odd);
    row[0] = __builtin_shuffle(a, c, low);
    row[1] = __builtin_shuffle(b, d, low);
    row[2] = __builtin_shuffle(a, c, high);
    row[3] = __builtin_shuffle(b, d, high);
}

static inline quad smaller(quad a, quad b)
{
    const mask is = a < b;
    return (quad)((is & (mask)a) | (~is & (mask)b));
}

static inline quad root(quad a)
{
#ifdef __AVX__ // sqrt may set errno, which no vector does
    return (quad)_mm256_sqrt_pd((__m256d)a);
#else
    return (quad){sqrt(a[0]), sqrt(a[1]), sqrt(a[2]), sqrt(a[3])};
#endif
}

static inline quad load(const double *from)
{
    quad a;
    memcpy(&a, from, sizeof a);
    return a;
}

static inline void store(double *to, quad a)
{
    memcpy(to, &a, sizeof a);
}

// Many at once, four by four and number by number as place_volume and place_of have
// them. Step by step through all of them: one force is a long chain of roots, quotients
// and reads, of which the processor then works on many.
enum { BATCH = 64 };
struct places {
    double u[BATCH], rest[BATCH], shrink[BATCH], zeta[BATCH], scale[BATCH];
    int64_t patch[BATCH];
    int row[BATCH];
    float across[BATCH], w[BATCH];
};

static inline void place_volumes(const double *volume, struct places *at)
{
    const quad zero = {0}, most = zero + BRIDGE_TABLE_MOST * (1 - 0x1p-53);
    for (int k = 0; k < BATCH; k += 4) {
        const quad v =
            smaller(-smaller(-load(&volume[k]), zero - BRIDGE_TABLE_LEAST), most);
        const mask bits = (mask)v, patch = (bits >> 49) - least_bits;
        store(&at->u[k],
              2 * (quad)((bits & 0x1ffffffffffff) << 3 | 0x3ff0000000000000) - 3);
        memcpy(&at->patch[k], &patch, sizeof patch);
    }
}

// 1 - a/A and 1/(1 + a/C).
static inline void stretch(const struct bridge_table *table, const double *gap,
                           struct places *at)
{
    const quad zero = {0};
    for (int k = 0; k < BATCH; k += 4) {
        quad row[8];
        for (int n = 0; n < 4; n++) {
            const struct volume_patch *patch = &table->volume[at->patch[k + n]];
            row[n] = load(patch->turning);
            row[4 + n] = load(patch->turning + 4);
        }
        transpose(row);
        transpose(row + 4);
        const quad a = -smaller(-load(&gap[k]), zero), u = load(&at->u[k]);
        store(&at->rest[k], 1 - a * POLYNOMIAL(row, u));
        store(&at->shrink[k], 1 / (1 + a * row[6]));
    }
}

static inline void place_along(struct places *at)
{
    const quad zero = {0};
    for (int k = 0; k < BATCH; k += 4) {
        const quad rest = load(&at->rest[k]), shrink = load(&at->shrink[k]);
        const quad zeta = root(-smaller(-rest, zero) * shrink), wide = WIDE * zeta;
        const quad x = wide + smaller(wide, zero + NARROW);
        typedef int four_int __attribute__((vector_size(16)));
        const four_int place =
            __builtin_convertvector(smaller(x, zero + (PLACES - 1)), four_int);
        const four across = __builtin_convertvector(load(&at->u[k]), four);
        const four w = __builtin_convertvector(
            2 * (x - __builtin_convertvector(place, quad)) - 1, four);
        store(&at->zeta[k], zeta);
        store(&at->scale[k], (quad)((mask)(shrink * shrink) & (rest > 0)));
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
        four term[4];
        for (int n = 0; n < 4; n++)
            term[n] = terms_of(table->force[at.patch[k + n]][at.row[k + n]],
                               at.across[k + n], at.w[k + n]);
        const four sum = sum_terms(term[0], term[1], term[2], term[3]);
        store(&force[k], load(&at.scale[k]) * __builtin_convertvector(sum, quad));
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
