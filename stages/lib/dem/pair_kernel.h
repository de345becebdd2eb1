// SPDX-License-Identifier: GPL-3.0-or-later
// The pair sweep: the forces between SIMD_WIDTH pairs at once. pair_avx2.c and
// pair_avx512.c include it with SIMD_WIDTH (4 or 8) and SWEEP_NAME, and so make one
// function for each set of features that a scene may need. In each, `features` is a
// constant, so the branches on it cost nothing.
//
// For pairs k of a group, in this order: find_pair_motion (distance, overlap,
// velocities, [K 4.7-4.17]); lane_law (coefficients at this overlap); contact and
// dashpots (pair_contact.h), rolling (pair_rolling.h), bonds (pair_bond.h), liquid;
// then scatter_loads adds
//     F_ij = F^n n + F^s to the second grain, -F_ij to the first,
//     M = arm n x F^s (+ moments of rolling and bonds) [K 4.18, 4.21, 4.43, 4.44].
// The arithmetic is that of each pair alone, in one order, fused where it says so, so
// both widths give the same bytes. tests/bench/bench_dem.c counts operations and bytes.
//
// What a sweep touches: it reads `place`, `motion` and the group (grains, separation,
// overlap); it reads and writes the histories (shear, rolling, bonds) and, with the
// balance, `loss`; it adds to `sum`; it writes `idle`, what is left of bonds that broke
// and, in the last cycle of a run, the loads. Threads sweep disjoint groups, and a
// grain that two of them have gets a row of `sum` for each pair (engine.h), so no two
// threads write one number.
//
// Lanes that do nothing are computed as well and masked, as branches for single lanes
// would cost more. The dummy grain of unused lanes is far from itself and gets loads of
// 0.
//
// A new feature takes a bit in enum feature, its sets in EACH_SET or its kin
// (engine.h), the choice in choose_features (create.c), an array of groups in pairs.h
// if it has a history, with a column in state_columns.c, and its term in sweep_lanes.
#include "dem/pair_bond.h"

// Subtracts ON_FIRST from the sums of the first grains and adds ON_SECOND to those of
// the second. One pair after the other, as pairs may have grains in common. Four
// doubles a row: force only, for scenes in which grains do not turn. The fourth number
// of a row stays 0.
SIMD_INLINE void add_four(double *sum, const uint32_t *first, const uint32_t *second,
                          struct rows on_first, struct rows on_second)
{
#pragma GCC unroll 8
    for (int k = 0; k < SIMD_WIDTH; k++) {
        *(double4 *)record(sum, 4, first[k]) -= quad_of(on_first, k);
        *(double4 *)record(sum, 4, second[k]) += quad_of(on_second, k);
    }
}

// The same with forces, opposite ones, and moments. A sum is one cache line: with 8
// lanes it is one vector. ON_FIRST is subtracted, too: callers give it the sign for
// that. A row is force x, y, z, 0 and moment x, y, z, 0. The two grains of a pair are
// the same only in unused lanes, where all is 0.
SIMD_INLINE void add_eight(double *sum, const uint32_t *first, const uint32_t *second,
                           struct rows force, struct rows on_first,
                           struct rows on_second)
{
#pragma GCC unroll 8
    for (int k = 0; k < SIMD_WIDTH; k++) {
        double *of_first = record(sum, 8, first[k]);
        double *of_second = record(sum, 8, second[k]);
#if SIMD_WIDTH == 8
        *(doublew *)of_first -= both_of(force, on_first, k);
        *(doublew *)of_second += both_of(force, on_second, k);
#else
        *(double4 *)of_first -= force.row[k];
        *(double4 *)(of_first + 4) -= on_first.row[k];
        *(double4 *)of_second += force.row[k];
        *(double4 *)(of_second + 4) += on_second.row[k];
#endif
    }
}

// The same with the same moment on both. With equal arms both grains are turned by the
// same moment, so one set of rows serves: subtracted as a whole from the first, added
// with the sign of its moment reversed to the second.
SIMD_INLINE void add_opposite(double *sum, const uint32_t *first,
                              const uint32_t *second, struct rows force,
                              struct rows moment)
{
#if SIMD_WIDTH == 8
    const doublew sign = {1, 1, 1, 1, -1, -1, -1, -1};
#pragma GCC unroll 8
    for (int k = 0; k < SIMD_WIDTH; k++) {
        const doublew both = both_of(force, moment, k);
        *(doublew *)(record(sum, 8, first[k])) -= both;
        double *of_second = record(sum, 8, second[k]);
        store(of_second, fmadd(sign, both, load(of_second)));
    }
#else
    struct rows opposite;
    for (int k = 0; k < 4; k++)
        opposite.row[k] = -moment.row[k];
    add_eight(sum, first, second, force, moment, opposite);
#endif
}

// Minus F_ij and minus what it turns for the first grain, the opposite force for the
// second [K 4.18, 4.21, 4.43, 4.44]. The moment about a centre is arm n x F^s: for the
// first grain the lever is arm_i n with the force -F^s, for the second -arm_j n with
// F^s; both give minus arm n x F^s. KEEP stores the loads for those who look after the
// run.
SIMD_INLINE void scatter_loads(const struct dem *dem, int k, int at,
                               const struct pair_motion *m,
                               const struct pair_load *pair, bool keep,
                               unsigned features)
{
    const struct vectorw n = m->rotation.normal;
    const struct pair_group *g = dem->pairs.group + k;
    const struct sum_group *sum = dem->pairs.sum + k;
    const bool has_shared_grain = dem->pairs.has_shared_grain[k];
    const uint32_t *first = (has_shared_grain ? sum->first : g->first) + at;
    const uint32_t *second = (has_shared_grain ? sum->second : g->second) + at;
    const bool turns = features & FEATURE_ROTATION;
    const struct vectorw force =
        turns ? add_scaled3(pair->shear, pair->normal, n) : scale3(pair->normal, n);
    if (keep) store3(dem->pairs.load[k].force, at, force);
    if (!turns) {
        add_four(dem->sum, first, second, rows_of(force), rows_of(force));
        return;
    }

    const struct vectorw torque = cross3(n, pair->shear);
    struct vectorw on_first, on_second;
    if (features & FEATURE_MOMENT) {
        on_first = add_scaled3(pair->moment, m->first_arm, torque);
        on_second = subtract_scaled3(pair->moment, m->second_arm, torque);
    } else {
        on_first = scale3(m->first_arm, torque);
        on_second = scale3(-m->second_arm, torque);
    }
    if (has_equal_arms(features) && !(features & FEATURE_MOMENT))
        add_opposite(dem->sum, first, second, rows_of(force), rows_of(on_first));
    else
        add_eight(dem->sum, first, second, rows_of(force), rows_of(on_first),
                  rows_of(on_second));
    if (!keep) return;
    store3(dem->pairs.moment[k].first, at, on_first);
    store3(dem->pairs.moment[k].second, at, on_second);
}

// The loads of lanes AT .. AT + SIMD_WIDTH - 1 of group K, whose MOTION is known.
// Returns how many bonds broke; BUSY is set where a pair touches, is bonded or pulls.
// Lanes of a group that was idle and is so still are left out: their loads are 0. In
// this order because each needs the one before: a contact bond breaks before friction
// acts on it, rolling friction needs the normal force, a bond's moment is added last.
// The pull of a bridge was found before the sweep (liquid.c); here it only acts.
// Energies are booked where they are lost: pull times V^n dt is what a bridge took from
// the motion in the step.
SIMD_INLINE int sweep_lanes(const struct dem *dem, int k, int at,
                            const struct pair_motion *motion,
                            const struct bond_law *bonds, doublew time_step, int *busy,
                            unsigned features)
{
    const doublew zero = {0};
    const struct pair_motion m = *motion;
    const maskw touch = at_least(m.overlap, zero);
    maskw bonded = above(zero, zero);
    if (features & FEATURE_BOND)
        bonded = at_least(load(dem->pairs.bonds[k].normal_strength + at), zero);
    const bool keep = dem->keeps_loads, wet = dem->pairs.liquid;
    const doublew pull = wet ? load(dem->pairs.liquid[k].pull + at) : zero;
    const maskw acts = either(either(touch, bonded), differs(pull, zero));
    if (!any(acts) && dem->pairs.idle[k] && !keep) return 0;

    *busy |= any(acts);
    int n_broken = 0;
    struct lane_law law = law_at(dem, k, at, &m, touch, time_step, features);
    if (features & FEATURE_CONTACT_BOND)
        n_broken = break_contact_bonds(&law, dem, k, at, &m, touch, &bonded, time_step,
                                       features);
    struct pair_load total =
        contact_load(dem, k, at, &m, touch, bonded, &law, time_step, features);
    if (features & FEATURE_ROLLING)
        total.moment = rolling_moment(dem, k, at, &m, touch, &law, total.normal,
                                      time_step, features);
    if (features & FEATURE_PARALLEL_BOND) {
        total.moment = (struct vectorw){zero, zero, zero};
        if (any(bonded))
            n_broken = add_bond_load(&total, dem, k, at, &m, bonded, bonds);
    }
    if (wet) {
        total.normal -= pull;
        if (dem->pairs.loss)
            add_to_ledger(dem->pairs.loss[k].bridges + at, acts,
                          pull * m.normal_velocity * time_step);
    }
    scatter_loads(dem, k, at, &m, &total, keep, features);
    return n_broken;
}

// Prefetches the records of second grains, which are scattered. First grains come in
// order, and the processor foresees them by itself. It pays only when grains do not fit
// into the cache, see CACHED.
SIMD_INLINE void fetch_ahead(const struct dem *dem, int k, unsigned features)
{
    const uint32_t *second = dem->pairs.group[k].second;
    const size_t stride = features & FEATURE_ROTATION ? 8 : 4;
    for (int lane = 0; lane < PAIRS_IN_GROUP; lane++) {
        const uint32_t j = second[lane];
        __builtin_prefetch(record((const double *)dem->place, 4, j));
        __builtin_prefetch(record(dem->velocity, stride, j));
        __builtin_prefetch(record(dem->sum, stride, j), 1);
    }
}

// One cycle of groups BEGIN .. END - 1. Returns how many bonds broke. FEATURES is a
// constant wherever this is inlined. Without a step done (cycle 0) the time step counts
// as 0: no history grows and no plane turns; dashpots see the velocities that were
// given.
SIMD_INLINE int sweep_groups(const struct dem *dem, int begin, int end,
                             unsigned features)
{
    const doublew zero = {0};
    // Velocities given at the start have displaced nothing yet.
    const doublew time_step = zero + (dem->cycle > 0 ? dem->time_step : 0);
    int n_broken = 0;
    enum { AHEAD = 8, CACHED = 4096 }; // groups; grains
    // Square roots and divisions have a long latency. So the motion of the pairs of a
    // block is found before any pair of it is swept.
    enum { BLOCK = 4 };
    const bool far = dem->n_particle > CACHED;
    const struct bond_law bonds = bond_law(dem, time_step);
    for (int begin_block = begin; begin_block < end; begin_block += BLOCK) {
        struct pair_motion motion[BLOCK][PAIRS_IN_GROUP / SIMD_WIDTH];
        const int next = begin_block + BLOCK < end ? begin_block + BLOCK : end;
        for (int k = begin_block; k < next; k++) {
            if (far && k + AHEAD < end) fetch_ahead(dem, k + AHEAD, features);
            for (int at = 0; at < PAIRS_IN_GROUP; at += SIMD_WIDTH)
                motion[k - begin_block][at / SIMD_WIDTH] =
                    find_pair_motion(dem, k, at, time_step, features);
        }
        for (int k = begin_block; k < next; k++) {
            int busy = 0;
            for (int at = 0; at < PAIRS_IN_GROUP; at += SIMD_WIDTH)
                n_broken +=
                    sweep_lanes(dem, k, at, &motion[k - begin_block][at / SIMD_WIDTH],
                                &bonds, time_step, &busy, features);
            dem->pairs.idle[k] = !busy;
        }
    }
    return n_broken;
}

// Gaps of the pairs of group K in effective radii, for liquid bridges; from
// displacements, as the overlap (pair_kinematics.h). Not fused, so that rounding is
// that of one pair. Returns a bit for each lane that touches or has a bridge. The gap
// is (d - d0 - U0) / radius with d - d0 = change / (d + d0), written over one
// denominator.
unsigned GAPS_NAME(const struct dem *dem, int k, double gap[PAIRS_IN_GROUP])
{
    const struct pair_group *g = &dem->pairs.group[k];
    const double *place = (const double *)dem->place;
    unsigned wet = 0;
    for (int at = 0; at < PAIRS_IN_GROUP; at += SIMD_WIDTH) {
        const struct vectorw start = load3(g->separation, at);
        const struct vectorw apart =
            transpose(subtract_rows(fetch(place, 4, g->second + at),
                                    fetch(place, 4, g->first + at)))
                .xyz;
        const struct vectorw now = add3(start, apart), both = add3(start, now);
        const doublew square = now.x * now.x + now.y * now.y + now.z * now.z;
        const doublew change = apart.x * both.x + apart.y * both.y + apart.z * both.z;
        const doublew sum = square_root(square) + load(g->distance + at);
        const doublew radius = load(dem->pairs.liquid[k].radius + at);
        const doublew now_apart =
            (change - load(g->overlap + at) * sum) / (sum * radius);
        store(gap + at, now_apart);
        const maskw acts =
            either(at_least(splat(0), now_apart),
                   above(load(dem->pairs.liquid[k].volume + at), splat(0)));
        for (int lane = 0; lane < SIMD_WIDTH; lane++)
            wet |= (unsigned)holds_in(acts, lane) << (at + lane);
    }
    return wet;
}

// One function a set of features, named sweep_avx2_K or sweep_avx512_K for the set K
// (engine.h declares them, pair_sweeps.c has the table).
#define SWEEP(features)                                                                \
    int SWEEP_NAME(features)(const struct dem *dem, int begin, int end)                \
    {                                                                                  \
        return sweep_groups(dem, begin, end, features);                                \
    }

EACH_SET(SWEEP)
EACH_PARALLEL_BOND_SET(SWEEP)
EACH_ROLLING_SET(SWEEP)
