// SPDX-License-Identifier: GPL-3.0-or-later
// The forces between LANES pairs at once; included by the files that define LANES (4 or
// 8) and SWEEP_NAME, the names of the functions made: one for each set of features that
// a scene may need, all from the one source below, where FEATURES is a constant. The
// arithmetic is that of each pair alone, in one order, fused where it says so and
// nowhere else, so every width gives the same bytes.
//
// Operations and bytes of a pair are counted in tests/bench/bench_dem.c.
#include "dem/pair_bond.h"

// Takes ON_FIRST from the sums of the first grains and adds ON_SECOND to those of the
// second. One pair after the other, as they may have grains in common.
INLINE void add_four(double *sum, const uint32_t *first, const uint32_t *second,
                     struct rows on_first, struct rows on_second)
{
#pragma GCC unroll 8
    for (int k = 0; k < LANES; k++) {
        *(quad *)record(sum, 4, first[k]) -= quad_of(on_first, k);
        *(quad *)record(sum, 4, second[k]) += quad_of(on_second, k);
    }
}

// The same with forces, opposite ones, and moments. A sum is one cache line: with 8
// lanes it is one vector.
INLINE void add_eight(double *sum, const uint32_t *first, const uint32_t *second,
                      struct rows force, struct rows on_first, struct rows on_second)
{
#pragma GCC unroll 8
    for (int k = 0; k < LANES; k++) {
        double *of_first = record(sum, 8, first[k]);
        double *of_second = record(sum, 8, second[k]);
#if LANES == 8
        *(lanes *)of_first -= both_of(force, on_first, k);
        *(lanes *)of_second += both_of(force, on_second, k);
#else
        *(quad *)of_first -= force.row[k];
        *(quad *)(of_first + 4) -= on_first.row[k];
        *(quad *)of_second += force.row[k];
        *(quad *)(of_second + 4) += on_second.row[k];
#endif
    }
}

// The same with the same moment on both.
INLINE void add_opposite(double *sum, const uint32_t *first, const uint32_t *second,
                         struct rows force, struct rows moment)
{
#if LANES == 8
    const lanes sign = {1, 1, 1, 1, -1, -1, -1, -1};
#pragma GCC unroll 8
    for (int k = 0; k < LANES; k++) {
        const lanes both = both_of(force, moment, k);
        *(lanes *)(record(sum, 8, first[k])) -= both;
        double *of_second = record(sum, 8, second[k]);
        store(of_second, fused(sign, both, load(of_second)));
    }
#else
    struct rows opposite;
    for (int k = 0; k < 4; k++)
        opposite.row[k] = -moment.row[k];
    add_eight(sum, first, second, force, moment, opposite);
#endif
}

// Minus F_ij and minus what it turns for the first grain, the opposite force for the
// second [K 4.18, 4.21, 4.43, 4.44].
INLINE void put_loads(const struct dem *dem, int k, int at, const struct meeting *m,
                      const struct pair_load *pair, bool keep, unsigned features)
{
    const struct lanes3 n = m->turning.normal;
    const struct pair_group *g = dem->pairs.group + k;
    const struct sum_group *sum = dem->pairs.sum + k;
    const bool elsewhere = dem->pairs.elsewhere[k];
    const uint32_t *first = (elsewhere ? sum->first : g->first) + at;
    const uint32_t *second = (elsewhere ? sum->second : g->second) + at;
    const bool turns = features & FEATURE_TURN;
    const struct lanes3 force =
        turns ? add_scaled3(pair->shear, pair->normal, n) : scale3(pair->normal, n);
    if (keep) store3(dem->pairs.load[k].force, at, force);
    if (!turns) {
        add_four(dem->sum, first, second, rows_of(force), rows_of(force));
        return;
    }

    const struct lanes3 torque = cross3(n, pair->shear);
    struct lanes3 on_first, on_second;
    if (features & FEATURE_PARALLEL_BOND) {
        on_first = add_scaled3(pair->moment, m->first_arm, torque);
        on_second = subtract_scaled3(pair->moment, m->second_arm, torque);
    } else {
        on_first = scale3(m->first_arm, torque);
        on_second = scale3(-m->second_arm, torque);
    }
    if (have_one_arm(features) && !(features & FEATURE_PARALLEL_BOND))
        add_opposite(dem->sum, first, second, rows_of(force), rows_of(on_first));
    else
        add_eight(dem->sum, first, second, rows_of(force), rows_of(on_first),
                  rows_of(on_second));
    if (!keep) return;
    store3(dem->pairs.moment[k].first, at, on_first);
    store3(dem->pairs.moment[k].second, at, on_second);
}

INLINE int sweep_lanes(const struct dem *dem, int k, int at, const struct meeting *met,
                       const struct bond_law *bonds, lanes time_step, int *busy,
                       unsigned features)
{
    const lanes zero = {0};
    const struct meeting m = *met;
    const mask touch = at_least(m.overlap, zero);
    mask held = above(zero, zero);
    if (features & FEATURE_BOND)
        held = at_least(load(dem->pairs.bonds[k].normal_strength + at), zero);
    const bool keep = dem->keeps_loads, wet = dem->pairs.liquid;
    const lanes pull = wet ? load(dem->pairs.liquid[k].pull + at) : zero;
    const mask acts = either(either(touch, held), unlike(pull, zero));
    if (!any(acts) && dem->pairs.idle[k] && !keep) return 0;

    *busy |= any(acts);
    int n_broken = 0;
    struct law law = law_at(dem, k, at, &m, touch, time_step, features);
    if (features & FEATURE_CONTACT_BOND)
        n_broken = break_contact_bonds(&law, dem, k, at, &m, touch, &held, time_step,
                                       features);
    struct pair_load total =
        contact_load(dem, k, at, &m, touch, held, &law, time_step, features);
    if (features & FEATURE_PARALLEL_BOND) {
        total.moment = (struct lanes3){zero, zero, zero};
        if (any(held)) n_broken = add_bond_load(&total, dem, k, at, &m, held, bonds);
    }
    if (wet) {
        total.normal -= pull;
        if (dem->pairs.loss)
            book(dem->pairs.loss[k].bridges + at, acts,
                 pull * m.normal_velocity * time_step);
    }
    put_loads(dem, k, at, &m, &total, keep, features);
    return n_broken;
}

// Asks early for the records of second grains, which lie here and there; first grains
// come in order, and the processor sees that for itself.
INLINE void fetch_ahead(const struct dem *dem, int k, unsigned features)
{
    const uint32_t *second = dem->pairs.group[k].second;
    const size_t stride = features & FEATURE_TURN ? 8 : 4;
    for (int lane = 0; lane < PAIRS_IN_GROUP; lane++) {
        const uint32_t j = second[lane];
        __builtin_prefetch(record((const double *)dem->place, 4, j));
        __builtin_prefetch(record((const double *)dem->motion, 8, j));
        __builtin_prefetch(record(dem->sum, stride, j), 1);
    }
}

INLINE int sweep_groups(const struct dem *dem, int begin, int end, unsigned features)
{
    const lanes zero = {0};
    // Velocities given at the start have displaced nothing yet.
    const lanes time_step = zero + (dem->cycle > 0 ? dem->time_step : 0);
    int n_broken = 0;
    enum { AHEAD = 8, CACHED = 4096 }; // groups; grains
    // Roots and quotients take long, and so does all that waits for them: how the pairs
    // of some groups meet is found before any of them is swept.
    enum { BLOCK = 4 };
    const bool far = dem->n_particle > CACHED;
    const struct bond_law bonds = bond_law(dem, time_step);
    for (int begin_block = begin; begin_block < end; begin_block += BLOCK) {
        struct meeting met[BLOCK][PAIRS_IN_GROUP / LANES];
        const int next = begin_block + BLOCK < end ? begin_block + BLOCK : end;
        for (int k = begin_block; k < next; k++) {
            if (far && k + AHEAD < end) fetch_ahead(dem, k + AHEAD, features);
            for (int at = 0; at < PAIRS_IN_GROUP; at += LANES)
                met[k - begin_block][at / LANES] =
                    meet(dem, k, at, time_step, features);
        }
        for (int k = begin_block; k < next; k++) {
            int busy = 0;
            for (int at = 0; at < PAIRS_IN_GROUP; at += LANES)
                n_broken += sweep_lanes(dem, k, at, &met[k - begin_block][at / LANES],
                                        &bonds, time_step, &busy, features);
            dem->pairs.idle[k] = !busy;
        }
    }
    return n_broken;
}

#define SWEEP(features)                                                                \
    int SWEEP_NAME(features)(const struct dem *dem, int begin, int end)                \
    {                                                                                  \
        return sweep_groups(dem, begin, end, features);                                \
    }

EACH_SET(SWEEP)
EACH_PARALLEL_BOND_SET(SWEEP)
