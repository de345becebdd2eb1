// SPDX-License-Identifier: GPL-3.0-or-later
// The forces between LANES pairs at once; included by the files that define LANES (4 or
// 8) and SWEEP_NAME, the names of the functions made: one for each set of features that
// a scene may need, all from the one source below, where FEATURES is a constant. The
// arithmetic is that of each pair alone, in one order, fused where it says so and
// nowhere else, so every width gives the same bytes.
//
// The overlap never is the difference of two large numbers. With s0 = x_j - x_i where
// the grains began, d0 = |s0| and du = u_j - u_i what the displacements add,
//     d^2 - d0^2 = du.(s0 + s),  so  stretch = d - d0 = du.(s0 + s) / (d + d0),
// and U^n = U0 - stretch [K 4.8] has the digits of du however small. The bond's normal
// force is linear in the distance, so its increments [K 4.32, 4.37] are summed at once:
// F^n = -k^n A stretch.
//
// Rotation of the history [K 4.13-4.15]. For a shear force F in the old contact plane
// F x (n_old x n) = n_old (F.n), and leapfrog gives n_old = n - t with t = V_t dt/d
// from the velocity that made the last displacement, so the old normal need not be
// kept. K's first-order rotations F - n_old (F.n) and F + a n x F lengthen F a little
// each time; with (n - t/2) for n_old and (1 - a^2/2) F the length holds to fourth
// order and F ends in the new plane exactly.
//
// Dashpots act where grains touch or an intact bond holds them: without them a bonded
// pair in tension would ring for ever. While an unbonded contact slides its shear
// dashpot is off, so that a sliding grain feels friction and nothing more.
//
// A Hertz contact that unloads forgets shear force as its shear stiffness falls, F^s
// times sqrt(U / U_old): with the incremental law alone a loop of loading would give
// energy out of nothing (Elata & Berryman 1996). U_old = U + V^n dt, by leapfrog.
//
// Operations and bytes of a pair are counted in tests/bench/bench_dem.c.
#include "dem/engine.h"

#include <immintrin.h>
#include <math.h>

// Vectors wider than the baseline are passed between inlined functions only.
#pragma GCC diagnostic ignored "-Wpsabi"

typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef double quad __attribute__((vector_size(32)));

struct lanes3 {
    lanes x, y, z;
};

#define INLINE static inline __attribute__((always_inline))

INLINE lanes splat(double a)
{
#if LANES == 8
    return (lanes){a, a, a, a, a, a, a, a};
#else
    return (lanes){a, a, a, a};
#endif
}

INLINE lanes load(const double *p)
{
    return *(const lanes *)p;
}

INLINE void store(double *p, lanes a)
{
    *(lanes *)p = a;
}

INLINE lanes magnitude(lanes a)
{
#if LANES == 8
    return (lanes)_mm512_abs_pd((__m512d)a);
#else
    return (lanes)_mm256_andnot_pd(_mm256_set1_pd(-0.0), (__m256d)a);
#endif
}

INLINE lanes square_root(lanes a)
{
#if LANES == 8
    return (lanes)_mm512_sqrt_pd((__m512d)a);
#else
    return (lanes)_mm256_sqrt_pd((__m256d)a);
#endif
}

// In which lanes something holds.
#if LANES == 8
typedef __mmask8 mask;
#define COMPARED(a, b, how) _mm512_cmp_pd_mask((__m512d)(a), (__m512d)(b), how)

INLINE mask either(mask a, mask b)
{
    return _kor_mask8(a, b);
}

INLINE mask both(mask a, mask b)
{
    return _kand_mask8(a, b);
}

INLINE mask without(mask a, mask b)
{
    return _kandn_mask8(b, a);
}

INLINE bool any(mask m)
{
    return m != 0;
}

INLINE bool holds_in(mask m, int lane)
{
    return m >> lane & 1;
}

INLINE lanes only_where(mask m, lanes a)
{
    return (lanes)_mm512_maskz_mov_pd(m, (__m512d)a);
}

INLINE lanes choose(mask m, lanes a, lanes b)
{
    return (lanes)_mm512_mask_blend_pd(m, (__m512d)b, (__m512d)a);
}
#else
typedef int64_t mask __attribute__((vector_size(8 * LANES)));
#define COMPARED(a, b, how) (mask) _mm256_cmp_pd((__m256d)(a), (__m256d)(b), how)

INLINE mask either(mask a, mask b)
{
    return a | b;
}

INLINE mask both(mask a, mask b)
{
    return a & b;
}

INLINE mask without(mask a, mask b)
{
    return a & ~b;
}

INLINE bool any(mask m)
{
    return _mm256_movemask_pd((__m256d)m) != 0;
}

INLINE bool holds_in(mask m, int lane)
{
    return m[lane] != 0;
}

INLINE lanes only_where(mask m, lanes a)
{
    return (lanes)(m & (mask)a);
}

INLINE lanes choose(mask m, lanes a, lanes b)
{
    return (lanes)_mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)m);
}
#endif

INLINE mask above(lanes a, lanes b)
{
    return COMPARED(a, b, _CMP_GT_OQ);
}

INLINE mask at_least(lanes a, lanes b)
{
    return COMPARED(a, b, _CMP_GE_OQ);
}

INLINE mask unlike(lanes a, lanes b)
{
    return COMPARED(a, b, _CMP_NEQ_UQ);
}

INLINE mask not_within(lanes a, lanes b) // A > B, or a number is none
{
    return COMPARED(a, b, _CMP_NLE_UQ);
}

INLINE struct lanes3 load3(const double (*p)[PAIRS_IN_GROUP], int at)
{
    return (struct lanes3){load(&p[0][at]), load(&p[1][at]), load(&p[2][at])};
}

INLINE void store3(double (*p)[PAIRS_IN_GROUP], int at, struct lanes3 a)
{
    store(&p[0][at], a.x);
    store(&p[1][at], a.y);
    store(&p[2][at], a.z);
}

INLINE struct lanes3 add3(struct lanes3 a, struct lanes3 b)
{
    return (struct lanes3){a.x + b.x, a.y + b.y, a.z + b.z};
}

INLINE struct lanes3 subtract3(struct lanes3 a, struct lanes3 b)
{
    return (struct lanes3){a.x - b.x, a.y - b.y, a.z - b.z};
}

INLINE struct lanes3 scale3(lanes s, struct lanes3 a)
{
    return (struct lanes3){s * a.x, s * a.y, s * a.z};
}

// A B + C, rounded once. Written out, as compilers do not contract alike.
INLINE lanes fused(lanes a, lanes b, lanes c)
{
#if LANES == 8
    return (lanes)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#else
    return (lanes)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#endif
}

INLINE struct lanes3 add_scaled3(struct lanes3 a, lanes s, struct lanes3 b)
{
    return (struct lanes3){fused(s, b.x, a.x), fused(s, b.y, a.y), fused(s, b.z, a.z)};
}

// A B - C and C - A B in the same way, without an instruction for the sign.
INLINE lanes fused_less(lanes a, lanes b, lanes c)
{
#if LANES == 8
    return (lanes)_mm512_fmsub_pd((__m512d)a, (__m512d)b, (__m512d)c);
#else
    return (lanes)_mm256_fmsub_pd((__m256d)a, (__m256d)b, (__m256d)c);
#endif
}

INLINE lanes less_fused(lanes a, lanes b, lanes c)
{
#if LANES == 8
    return (lanes)_mm512_fnmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#else
    return (lanes)_mm256_fnmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#endif
}

INLINE struct lanes3 subtract_scaled3(struct lanes3 a, lanes s, struct lanes3 b)
{
    return (struct lanes3){less_fused(s, b.x, a.x), less_fused(s, b.y, a.y),
                           less_fused(s, b.z, a.z)};
}

INLINE struct lanes3 only_where3(mask m, struct lanes3 a)
{
    return (struct lanes3){only_where(m, a.x), only_where(m, a.y), only_where(m, a.z)};
}

INLINE lanes dot3(struct lanes3 a, struct lanes3 b)
{
    return fused(a.z, b.z, fused(a.y, b.y, a.x * b.x));
}

INLINE struct lanes3 cross3(struct lanes3 a, struct lanes3 b)
{
    return (struct lanes3){fused_less(a.y, b.z, a.z * b.y),
                           fused_less(a.z, b.x, a.x * b.z),
                           fused_less(a.x, b.y, a.y * b.x)};
}

// A - B x C.
INLINE struct lanes3 subtract_cross3(struct lanes3 a, struct lanes3 b, struct lanes3 c)
{
    return (struct lanes3){less_fused(b.y, c.z, fused(b.z, c.y, a.x)),
                           less_fused(b.z, c.x, fused(b.x, c.z, a.y)),
                           less_fused(b.x, c.y, fused(b.y, c.x, a.z))};
}

// Four numbers from each of LANES places, transposed to three vectors and a fourth.
struct lanes4 {
    struct lanes3 xyz;
    lanes w;
};

// The record of STRIDE numbers, 4 or 8, that INDEX names.
INLINE double *record(const double *base, size_t stride, uint32_t index)
{
    return (double *)((uintptr_t)base + stride * sizeof *base / NUMBER_STEP * index);
}

INLINE quad load_quad(const double *base, size_t stride, uint32_t index)
{
    return *(const quad *)record(base, stride, index);
}

#if LANES == 8
#define PAIR_UP(a, b)                                                                  \
    (lanes) _mm512_insertf64x4(_mm512_castpd256_pd512((__m256d)(a)), (__m256d)(b), 1)
#define EVEN(a, b) __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14)
#define ODD(a, b) __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15)
#define LOWER(a, b) __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13)
#define UPPER(a, b) __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15)
#define LOWER_TWO(a, b) __builtin_shufflevector(a, b, 0, 1, 8, 9, 2, 3, 10, 11)
#define UPPER_TWO(a, b) __builtin_shufflevector(a, b, 4, 5, 12, 13, 6, 7, 14, 15)
#define ROW(k) PAIR_UP(load_quad(p, stride, i[k]), load_quad(p, stride, i[(k) + 2]))
#define ROWS                                                                           \
    {                                                                                  \
        ROW(0), ROW(1), ROW(4), ROW(5)                                                 \
    }
#else
#define EVEN(a, b) __builtin_shufflevector(a, b, 0, 4, 2, 6)
#define ODD(a, b) __builtin_shufflevector(a, b, 1, 5, 3, 7)
#define LOWER(a, b) __builtin_shufflevector(a, b, 0, 1, 4, 5)
#define UPPER(a, b) __builtin_shufflevector(a, b, 2, 3, 6, 7)
#define LOWER_TWO LOWER
#define UPPER_TWO UPPER
#define ROW(k) load_quad(p, stride, i[k])
#define ROWS                                                                           \
    {                                                                                  \
        ROW(0), ROW(1), ROW(2), ROW(3)                                                 \
    }
#endif

// As fetched: two records of four in each (LANES = 8), or one.
struct rows {
    lanes row[4];
};

INLINE struct rows fetch(const double *p, size_t stride, const uint32_t *i)
{
    return (struct rows){ROWS};
}

INLINE struct rows add_rows(struct rows a, struct rows b)
{
    for (int k = 0; k < 4; k++)
        a.row[k] += b.row[k];
    return a;
}

INLINE struct rows subtract_rows(struct rows a, struct rows b)
{
    for (int k = 0; k < 4; k++)
        a.row[k] -= b.row[k];
    return a;
}

INLINE struct lanes4 transpose(struct rows a)
{
    const lanes xz0 = EVEN(a.row[0], a.row[1]), xz1 = EVEN(a.row[2], a.row[3]);
    const lanes yw0 = ODD(a.row[0], a.row[1]), yw1 = ODD(a.row[2], a.row[3]);
    return (struct lanes4){{LOWER(xz0, xz1), LOWER(yw0, yw1), UPPER(xz0, xz1)},
                           UPPER(yw0, yw1)};
}

// The reverse: row k of four is A, with zero for a fourth, of one lane (LANES = 4) or
// of two, in the order of ROWS.
INLINE struct rows rows_of(struct lanes3 a)
{
    const lanes zero = {0};
    const lanes xy0 = EVEN(a.x, a.y), xy1 = ODD(a.x, a.y);
    const lanes zw0 = EVEN(a.z, zero), zw1 = ODD(a.z, zero);
    return (struct rows){{LOWER_TWO(xy0, zw0), LOWER_TWO(xy1, zw1), UPPER_TWO(xy0, zw0),
                          UPPER_TWO(xy1, zw1)}};
}

// Lane K of ROWS.
INLINE quad quad_of(struct rows rows, int k)
{
#if LANES == 8
    const lanes row = rows.row[(k & 1) + (k & 4) / 2];
    return k & 2 ? __builtin_shufflevector(row, row, 4, 5, 6, 7)
                 : __builtin_shufflevector(row, row, 0, 1, 2, 3);
#else
    return rows.row[k];
#endif
}

#if LANES == 8
// Lane K of A and of B.
INLINE lanes both_of(struct rows a, struct rows b, int k)
{
    const int r = (k & 1) + (k & 4) / 2;
    return k & 2
               ? __builtin_shufflevector(a.row[r], b.row[r], 4, 5, 6, 7, 12, 13, 14, 15)
               : __builtin_shufflevector(a.row[r], b.row[r], 0, 1, 2, 3, 8, 9, 10, 11);
}
#endif

// How the contact plane has turned in the last time step.
struct turning {
    struct lanes3 normal;
    struct lanes3 middle; // n - t/2
    lanes spin;           // a, about n
    lanes shrink;         // 1 - a^2/2
};

INLINE struct lanes3 turn(struct turning by, struct lanes3 f)
{
    const struct lanes3 flat = subtract_scaled3(f, dot3(f, by.normal), by.middle);
    return add_scaled3(scale3(by.shrink, flat), by.spin, cross3(by.normal, flat));
}

// Whether the contact is as far from one grain's centre as from the other's.
INLINE bool have_one_arm(unsigned features)
{
    return !(features & FEATURE_OWN);
}

// How pairs lie and move [K 4.7-4.9, 4.15, 4.17].
struct meeting {
    struct turning turning;
    lanes stretch, overlap;
    lanes first_arm, second_arm; // from the centres to the contact point
    lanes normal_velocity;
    struct lanes3 shear_velocity; // V^s
    struct lanes3 turning_apart;  // omega_j - omega_i
};

// The surfaces' velocity at the contact is that of the centres less rolling x n.
struct spinning {
    struct lanes3 sum, rolling;
    struct lanes3 apart; // omega_j - omega_i
};

INLINE struct spinning spins_of(const struct meeting *m, const double *spins,
                                const uint32_t *i, const uint32_t *j, unsigned features)
{
    const struct rows rows_i = fetch(spins, 8, i), rows_j = fetch(spins, 8, j);
    struct spinning s;
    if (features & FEATURE_PARALLEL_BOND)
        s.apart = transpose(subtract_rows(rows_j, rows_i)).xyz;
    if (have_one_arm(features)) {
        s.sum = transpose(add_rows(rows_i, rows_j)).xyz;
        s.rolling = scale3(m->first_arm, s.sum);
        return s;
    }
    const struct lanes3 spin_i = transpose(rows_i).xyz, spin_j = transpose(rows_j).xyz;
    s.sum = add3(spin_i, spin_j);
    s.rolling = add_scaled3(scale3(m->first_arm, spin_i), m->second_arm, spin_j);
    return s;
}

// What only grains that turn need.
INLINE void meet_turning(struct meeting *m, const struct spinning *spins,
                         struct lanes3 velocity, lanes inverse, lanes time_step,
                         unsigned features)
{
    const struct lanes3 n = m->turning.normal;
    const struct lanes3 sideways = subtract_scaled3(velocity, m->normal_velocity, n);
    m->shear_velocity = features & FEATURE_PARALLEL_BOND
                            ? subtract_cross3(sideways, spins->rolling, n)
                            : subtract3(sideways, cross3(spins->rolling, n));
    m->turning_apart = spins->apart;
    m->turning.middle = subtract_scaled3(n, 0.5 * time_step * inverse, sideways);
    m->turning.spin = 0.5 * time_step * dot3(spins->sum, n);
    m->turning.shrink = 1.0 - 0.5 * m->turning.spin * m->turning.spin;
}

// 1/d and 1/(d + d0). Dividing takes as long as some thirty multiplications: one
// division does for both where the bytes may change with it.
struct inverses {
    lanes distance, sum;
};

INLINE struct inverses invert(lanes distance, lanes distance_at_start)
{
    const lanes d = distance + 1e-300; // n = 0 if they ever coincide
    const lanes sum = d + distance_at_start;
    const lanes both = 1.0 / (d * sum);
    return (struct inverses){both * sum, both * d};
}

// How pairs lie.
struct lie {
    struct lanes3 separation;
    lanes inverse; // 1 / d
    lanes stretch;
    struct rows place_i, place_j;
};

// Distances that changed little, as between bonded grains, need neither root nor
// quotient, which keep their unit of the processor busy for longer than all else that
// bonds need: with x = (d^2 - d0^2) / d0^2,
//     1 / d = (1 + x)^(-1/2) / d0,  stretch = d0 x ((1 + x)^(1/2) - 1) / x,
// by Taylor series to rounding while |x| is at most this.
#define SMALL_CHANGE 0x1p-11

INLINE lanes series(lanes x, double c0, double c1, double c2, double c3, double c4)
{
    lanes sum = fused(splat(c4), x, splat(c3));
    sum = fused(sum, x, splat(c2));
    sum = fused(sum, x, splat(c1));
    return fused(sum, x, splat(c0));
}

INLINE void measure(struct lie *lie, lanes grown, lanes distance_at_start)
{
    const lanes distance = square_root(dot3(lie->separation, lie->separation));
    const struct inverses inverses = invert(distance, distance_at_start);
    lie->inverse = inverses.distance;
    lie->stretch = grown * inverses.sum;
}

INLINE void measure_small(struct lie *lie, lanes grown, const struct pair_group *g,
                          int at)
{
    const lanes inverse = load(g->inverse_distance + at);
    const lanes by_distance = grown * inverse, x = by_distance * inverse;
    const mask large = not_within(magnitude(x), splat(SMALL_CHANGE));
    struct lie small = *lie;
    small.inverse = inverse * series(x, 1, -1. / 2, 3. / 8, -5. / 16, 35. / 128);
    small.stretch =
        by_distance * series(x, 1. / 2, -1. / 8, 1. / 16, -5. / 128, 7. / 256);
    if (any(large)) {
        measure(lie, grown, load(g->distance + at));
        small.inverse = choose(large, lie->inverse, small.inverse);
        small.stretch = choose(large, lie->stretch, small.stretch);
    }
    lie->inverse = small.inverse;
    lie->stretch = small.stretch;
}

INLINE struct lie look(const struct dem *dem, int k, int at, unsigned features)
{
    const struct pair_group *g = dem->pairs.group + k;
    const double *places = (const double *)dem->place;
    struct lie lie = {.place_i = fetch(places, 4, g->first + at),
                      .place_j = fetch(places, 4, g->second + at)};
    const struct lanes3 apart = transpose(subtract_rows(lie.place_j, lie.place_i)).xyz;
    const struct lanes3 start = load3(g->separation, at);
    lie.separation = add3(start, apart);
    const lanes grown = dot3(apart, add3(start, lie.separation)); // d^2 - d0^2
    if (features & FEATURE_PARALLEL_BOND)
        measure_small(&lie, grown, g, at);
    else
        measure(&lie, grown, load(g->distance + at));
    return lie;
}

INLINE struct meeting meet(const struct dem *dem, int k, int at, lanes time_step,
                           unsigned features)
{
    const struct lie looked = look(dem, k, at, features), *lie = &looked;
    const struct pair_group *g = dem->pairs.group + k;
    const uint32_t *i = g->first + at, *j = g->second + at;
    const double *motions = (const double *)dem->motion;
    const struct lanes3 velocity =
        transpose(subtract_rows(fetch(motions, 8, j), fetch(motions, 8, i))).xyz;
    struct meeting m = {.stretch = lie->stretch};
    m.turning.normal = scale3(lie->inverse, lie->separation);
    m.overlap = load(g->overlap + at) - m.stretch;
    const lanes radius = splat(dem->place[0].radius); // of all, unless they differ
    const bool differ = features & FEATURE_OWN;
    const lanes first_radius = differ ? transpose(lie->place_i).w : radius;
    const lanes second_radius = differ ? transpose(lie->place_j).w : radius;
    // Arms that together are the distance, also where an overlap does not push.
    const lanes shared = dem->unstressed ? first_radius + second_radius -
                                               load(g->distance + at) - m.stretch
                                         : m.overlap;
    m.first_arm = first_radius - 0.5 * shared;
    m.second_arm = have_one_arm(features) ? m.first_arm : second_radius - 0.5 * shared;
    m.normal_velocity = dot3(velocity, m.turning.normal);
    if (!(features & FEATURE_TURN)) return m;
    const struct spinning spins = spins_of(&m, motions + 4, i, j, features);
    meet_turning(&m, &spins, velocity, lie->inverse, time_step, features);
    return m;
}

// The numbers of a contact as they are at its overlap.
struct law {
    lanes spring; // normal force
    lanes shear_stiffness, normal_damping, shear_damping, friction;
    // Hertz: what is left of the shear force of the step before, and the shear
    // stiffness that it had.
    lanes forget, shear_stiffness_before;
};

INLINE struct law law_at(const struct dem *dem, int k, int at, const struct meeting *m,
                         mask touch, lanes time_step, unsigned features)
{
    const struct contact_law *all = &dem->law;
    const struct own_group *own = dem->pairs.own + k;
    const bool differ = features & FEATURE_OWN;
    const lanes stiffness =
        differ ? load(own->normal_stiffness + at) : splat(all->normal_stiffness);
    struct law law = {.shear_stiffness = differ ? load(own->shear_stiffness + at)
                                                : splat(all->shear_stiffness),
                      .normal_damping = differ ? load(own->normal_damping + at)
                                               : splat(all->normal_damping),
                      .shear_damping = differ ? load(own->shear_damping + at)
                                              : splat(all->shear_damping),
                      .friction =
                          differ ? load(own->friction + at) : splat(all->friction)};
    if (!(features & FEATURE_HERTZ)) {
        law.spring = only_where(touch, stiffness * m->overlap);
        law.shear_stiffness_before = law.shear_stiffness;
        return law;
    }
    const lanes overlap = only_where(touch, m->overlap);
    const lanes root = square_root(overlap), fourth = square_root(root);
    const lanes before = m->overlap + time_step * m->normal_velocity;
    const mask was = above(before, splat(0));
    law.spring = stiffness * overlap * root;
    law.shear_stiffness_before =
        law.shear_stiffness * square_root(only_where(was, before));
    law.shear_stiffness *= root;
    law.normal_damping *= fourth;
    law.shear_damping *= fourth;
    const mask unloads = both(was, above(before, overlap));
    law.forget =
        choose(unloads, square_root(overlap / choose(was, before, splat(1))), splat(1));
    return law;
}

// What a pair feels: along n, in the contact plane, and moments carried by the bond.
struct pair_load {
    lanes normal;
    struct lanes3 shear;
    struct lanes3 moment;
};

INLINE void book(double *account, mask where, lanes amount)
{
    store(account, load(account) + only_where(where, amount));
}

// Energy that the shear spring loses when its force and stiffness go from BEFORE and
// STIFFNESS_BEFORE to AFTER and STIFFNESS; a stiffness of 0 holds none.
INLINE lanes spring_loss(struct lanes3 before, lanes stiffness_before,
                         struct lanes3 after, lanes stiffness)
{
    const lanes had =
        only_where(above(stiffness_before, splat(0)),
                   dot3(before, before) / choose(above(stiffness_before, splat(0)),
                                                 stiffness_before, splat(1)));
    const lanes has = only_where(
        above(stiffness, splat(0)),
        dot3(after, after) / choose(above(stiffness, splat(0)), stiffness, splat(1)));
    return 0.5 * (had - has);
}

// The shear spring of the contact, slip included [K 4.12-4.16, 4.25-4.26]; SLIPS says
// where.
INLINE struct lanes3 shear_spring(const struct dem *dem, int k, int at,
                                  const struct meeting *m, const struct law *law,
                                  mask touch, mask held, lanes time_step,
                                  unsigned features, mask *slips)
{
    double(*history)[PAIRS_IN_GROUP] = dem->pairs.shear[k].force;
    const mask acts = features & FEATURE_CONTACT_BOND ? either(touch, held) : touch;
    const struct lanes3 turned = turn(m->turning, load3(history, at));
    const bool forgets = features & FEATURE_HERTZ || dem->pairs.loss;
    struct lanes3 kept = forgets ? only_where3(acts, turned) : turned;
    if (features & FEATURE_HERTZ) kept = scale3(law->forget, kept);
    const struct lanes3 trial =
        only_where3(acts, subtract_scaled3(kept, law->shear_stiffness * time_step,
                                           m->shear_velocity));

    const lanes limit = law->friction * law->spring;
    const lanes square = dot3(trial, trial);
    *slips = above(square, limit * limit);
    if (features & FEATURE_CONTACT_BOND) *slips = without(*slips, held);
    struct lanes3 shear = trial;
    if (any(*slips)) {
        const lanes factor = limit / square_root(choose(*slips, square, splat(1)));
        shear = scale3(choose(*slips, factor, splat(1)), trial);
    }
    store3(history, at, shear);
    if (dem->pairs.loss) { // what a contact forgot, and what slip took: the mean force
                           // times the slip
        const lanes now = law->shear_stiffness, before = law->shear_stiffness_before;
        const lanes slip = dot3(add3(kept, shear), subtract3(trial, shear));
        const lanes taken =
            only_where(above(now, splat(0)),
                       0.5 * slip / choose(above(now, splat(0)), now, splat(1)));
        book(dem->pairs.loss[k].slip + at, at_least(splat(0), splat(0)),
             spring_loss(turned, before, kept, now) + taken);
    }
    return shear;
}

// Contact and dashpots [K 4.11-4.16, 4.25-4.30]; TOUCH and HELD (by a bond) are masks.
INLINE struct pair_load contact_load(const struct dem *dem, int k, int at,
                                     const struct meeting *m, mask touch, mask held,
                                     const struct law *law, lanes time_step,
                                     unsigned features)
{
    const lanes dashpot = law->normal_damping * m->normal_velocity;
    struct pair_load load = {.normal = law->spring -
                                       only_where(either(touch, held), dashpot)};
    if (dem->pairs.loss)
        book(dem->pairs.loss[k].dashpots + at, either(touch, held),
             dashpot * m->normal_velocity * time_step);
    if (!(features & FEATURE_TURN)) return load;

    mask slips;
    const struct lanes3 shear =
        shear_spring(dem, k, at, m, law, touch, held, time_step, features, &slips);
    const mask sticks = either(held, without(touch, slips));
    const lanes damping = only_where(sticks, law->shear_damping);
    load.shear = subtract_scaled3(shear, damping, m->shear_velocity);
    if (dem->pairs.loss)
        book(dem->pairs.loss[k].dashpots + at, sticks,
             damping * dot3(m->shear_velocity, m->shear_velocity) * time_step);
    return load;
}

// A bond broke in lane LANE: rare. Of two modes in one step the one that is further
// past its strength counts.
static __attribute__((noinline)) void break_bond(struct bond_group *b, int lane,
                                                 bool by_normal, bool by_shear,
                                                 double normal, double shear)
{
    const bool normal_leads =
        normal * b->shear_strength[lane] >= shear * b->normal_strength[lane];
    const bool cracks_in_shear = by_shear && !(by_normal && normal_leads);
    b->crack[lane] = cracks_in_shear ? DEM_CRACK_SHEAR : DEM_CRACK_NORMAL;
    b->radius[lane] = 0;
    b->normal_strength[lane] = -1;
    b->shear_strength[lane] = -1;
}

// Adds the bonds of the lanes HELD, and breaks them [K 4.31-4.44]. Stresses are
// compared times A R: sigma_max A R = -F^n R + 4 |M^s| as A R^2 = 4 I, and tau_max A R
// = |F^s| R + 2 |M^n| as A R^2 = 2 J. Squares spare the roots.
INLINE int add_bond_load(struct pair_load *total, const struct dem *dem, int k, int at,
                         const struct meeting *m, mask held, lanes time_step)
{
    const lanes zero = {0};
    struct bond_group *g = dem->pairs.bonds + k;
    const double normal_stiffness = dem->bond_normal_stiffness;
    const double shear_stiffness = dem->bond_shear_stiffness;
    const struct lanes3 n = m->turning.normal;
    const lanes radius = load(g->radius + at), square = radius * radius;
    const lanes area = M_PI * square, inertia = area * square; // A, and 4 I = 2 J

    lanes tension = normal_stiffness * area * m->stretch;
    struct lanes3 shear = turn(m->turning, load3(g->shear_force, at));
    shear =
        subtract_scaled3(shear, shear_stiffness * time_step * area, m->shear_velocity);

    const lanes twisting = dot3(m->turning_apart, n);
    lanes twist = load(g->twist + at);
    twist = less_fused(0.5 * shear_stiffness * time_step * inertia, twisting, twist);
    struct lanes3 bending = turn(m->turning, load3(g->bending, at));
    bending = subtract_scaled3(bending, 0.25 * normal_stiffness * time_step * inertia,
                               subtract_scaled3(m->turning_apart, twisting, n));

    const lanes bending_left =
        less_fused(tension, radius, load(g->normal_strength + at));
    const lanes twist_size = magnitude(twist);
    const lanes shear_left = load(g->shear_strength + at) - 2.0 * twist_size;
    const lanes bending_square = 16.0 * dot3(bending, bending);
    const lanes shear_square = square * dot3(shear, shear);
    const mask by_normal =
        both(held, either(at_least(splat(0), bending_left),
                          at_least(bending_square, bending_left * bending_left)));
    const mask by_shear =
        both(held, either(at_least(splat(0), shear_left),
                          at_least(shear_square, shear_left * shear_left)));

    const mask broken = either(by_normal, by_shear);
    int count = 0;
    if (any(broken)) {
        const lanes normal_load = square_root(bending_square) + tension * radius;
        const lanes shear_load = 2.0 * twist_size + square_root(shear_square);
        for (int lane = 0; lane < LANES; lane++) {
            if (!holds_in(broken, lane)) continue;
            break_bond(g, at + lane, holds_in(by_normal, lane),
                       holds_in(by_shear, lane), normal_load[lane], shear_load[lane]);
            count++;
        }
        if (dem->pairs.loss) {
            const lanes stretched = normal_stiffness * area;
            const lanes sheared = shear_stiffness * area;
            const lanes bent = 0.25 * normal_stiffness * inertia;
            const lanes twisted = 0.5 * shear_stiffness * inertia;
            const struct lanes3 nothing = {zero, zero, zero};
            const lanes energy = spring_loss((struct lanes3){tension, zero, zero},
                                             stretched, nothing, stretched) +
                                 spring_loss(shear, sheared, nothing, sheared) +
                                 spring_loss(bending, bent, nothing, bent) +
                                 spring_loss((struct lanes3){twist, zero, zero},
                                             twisted, nothing, twisted);
            book(dem->pairs.loss[k].broken + at, broken, energy);
        }
        const mask whole = without(held, broken);
        tension = only_where(whole, tension);
        shear = only_where3(whole, shear);
        bending = only_where3(whole, bending);
        twist = only_where(whole, twist);
    }

    store3(g->shear_force, at, shear);
    store3(g->bending, at, bending);
    store(g->twist + at, twist);
    total->normal -= tension;
    total->shear = add3(total->shear, shear);
    total->moment = add_scaled3(bending, twist, n);
    return count;
}

// Contact bonds pull with the springs of the contact; those past a strength break and
// leave what friction allows [K 4.2]. HELD loses the lanes that broke.
INLINE int break_contact_bonds(struct law *law, const struct dem *dem, int k, int at,
                               const struct meeting *m, mask touch, mask *held,
                               lanes time_step, unsigned features)
{
    const lanes zero = {0};
    struct bond_group *g = dem->pairs.bonds + k;
    const lanes stiffness = features & FEATURE_OWN
                                ? load(dem->pairs.own[k].normal_stiffness + at)
                                : splat(dem->law.normal_stiffness);
    const lanes spring = stiffness * m->overlap;
    struct lanes3 shear = turn(m->turning, load3(dem->pairs.shear[k].force, at));
    shear =
        subtract3(shear, scale3(law->shear_stiffness * time_step, m->shear_velocity));
    const lanes normal_strength = load(g->normal_strength + at);
    const lanes shear_strength = load(g->shear_strength + at);
    const lanes square = dot3(shear, shear);
    const mask by_normal = both(*held, at_least(-spring, normal_strength));
    const mask by_shear =
        both(*held, at_least(square, shear_strength * shear_strength));
    const mask broken = either(by_normal, by_shear);
    int count = 0;
    if (any(broken)) {
        const lanes shear_load = square_root(square);
        for (int lane = 0; lane < LANES; lane++) {
            if (!holds_in(broken, lane)) continue;
            break_bond(g, at + lane, holds_in(by_normal, lane),
                       holds_in(by_shear, lane), -spring[lane], shear_load[lane]);
            count++;
        }
        // In tension all is lost; otherwise what slips from now on is slip's.
        const mask apart = without(broken, touch);
        double(*history)[PAIRS_IN_GROUP] = dem->pairs.shear[k].force;
        const struct lanes3 was = load3(history, at);
        const mask all = at_least(zero, zero);
        store3(history, at, only_where3(without(all, apart), was));
        if (dem->pairs.loss) {
            const struct lanes3 nothing = {zero, zero, zero};
            const lanes across = law->shear_stiffness;
            book(dem->pairs.loss[k].broken + at, apart,
                 0.5 * spring * m->overlap + spring_loss(was, across, nothing, across));
        }
        *held = without(*held, broken);
    }
    law->spring = only_where(either(touch, *held), spring);
    return count;
}

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
                       lanes time_step, int *busy, unsigned features)
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
        if (any(held))
            n_broken = add_bond_load(&total, dem, k, at, &m, held, time_step);
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
                                        time_step, &busy, features);
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
