// SPDX-License-Identifier: GPL-3.0-or-later
// The forces between LANES pairs at once; included by the files that define LANES (4 or
// 8) and PAIR_SWEEP, the name of the function made. The arithmetic is that of each pair
// alone, in one order, without fused operations, so every width gives the same bytes.
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
// With its bond a pair costs 296 operations, of which 3 divisions and a square root. It
// streams 250 bytes of its own (72 constant, 80 of history read and written, 17 of
// indices) and 128 written to slots, and reads 192 of its two grains, which stay
// cached.
#include "dem/engine.h"

#include <immintrin.h>
#include <math.h>

// Vectors wider than the baseline are passed between inlined functions only.
#pragma GCC diagnostic ignored "-Wpsabi"

typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef int64_t mask __attribute__((vector_size(8 * LANES)));
typedef double quad __attribute__((vector_size(32)));

struct lanes3 {
    lanes x, y, z;
};

#define INLINE static inline __attribute__((always_inline))

INLINE lanes load(const double *p)
{
    return *(const lanes *)p;
}

INLINE void store(double *p, lanes a)
{
    *(lanes *)p = a;
}

INLINE lanes only_where(mask m, lanes a)
{
    return (lanes)(m & (mask)a);
}

INLINE lanes choose(mask m, lanes a, lanes b)
{
    return (lanes)((m & (mask)a) | (~m & (mask)b));
}

INLINE lanes square_root(lanes a)
{
#if LANES == 8
    return (lanes)_mm512_sqrt_pd((__m512d)a);
#else
    return (lanes)_mm256_sqrt_pd((__m256d)a);
#endif
}

INLINE int any(mask m)
{
#if LANES == 8
    return _mm512_test_epi64_mask((__m512i)m, (__m512i)m) != 0;
#else
    return _mm256_movemask_pd((__m256d)m) != 0;
#endif
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

INLINE struct lanes3 only_where3(mask m, struct lanes3 a)
{
    return (struct lanes3){only_where(m, a.x), only_where(m, a.y), only_where(m, a.z)};
}

INLINE lanes dot3(struct lanes3 a, struct lanes3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

INLINE struct lanes3 cross3(struct lanes3 a, struct lanes3 b)
{
    return (struct lanes3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                           a.x * b.y - a.y * b.x};
}

// Four numbers from each of LANES places, transposed to three vectors and a fourth.
struct lanes4 {
    struct lanes3 xyz;
    lanes w;
};

INLINE quad load_quad(const double *base, size_t stride, int32_t index)
{
    return *(const quad *)(base + stride * (size_t)index);
}

#if LANES == 8
#define PAIR_UP(a, b) __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7)
#define EVEN(a, b) __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14)
#define ODD(a, b) __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15)
#define LOWER(a, b) __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13)
#define UPPER(a, b) __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15)
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
#define ROW(k) load_quad(p, stride, i[k])
#define ROWS                                                                           \
    {                                                                                  \
        ROW(0), ROW(1), ROW(2), ROW(3)                                                 \
    }
#endif

INLINE struct lanes4 gather(const double *p, size_t stride, const int32_t *i)
{
    const lanes row[4] = ROWS;
    const lanes xz0 = EVEN(row[0], row[1]), xz1 = EVEN(row[2], row[3]);
    const lanes yw0 = ODD(row[0], row[1]), yw1 = ODD(row[2], row[3]);
    return (struct lanes4){{LOWER(xz0, xz1), LOWER(yw0, yw1), UPPER(xz0, xz1)},
                           UPPER(yw0, yw1)};
}

// The reverse: A, with zero for a fourth, to LANES places.
INLINE void scatter(double *p, const int32_t *i, struct lanes3 a)
{
    const lanes zero = {0};
    const lanes xy0 = EVEN(a.x, a.y), xy1 = ODD(a.x, a.y);
    const lanes zw0 = EVEN(a.z, zero), zw1 = ODD(a.z, zero);
#if LANES == 8
#define PUT(k, xy, zw, n)                                                              \
    *(quad *)(p + 8 * (size_t)i[k]) = __builtin_shufflevector(                         \
        xy, zw, 2 * (n), 2 * (n) + 1, 2 * (n) + 8, 2 * (n) + 9)
    PUT(0, xy0, zw0, 0);
    PUT(1, xy1, zw1, 0);
    PUT(2, xy0, zw0, 1);
    PUT(3, xy1, zw1, 1);
    PUT(4, xy0, zw0, 2);
    PUT(5, xy1, zw1, 2);
    PUT(6, xy0, zw0, 3);
    PUT(7, xy1, zw1, 3);
#undef PUT
#else
    *(quad *)(p + 8 * (size_t)i[0]) = LOWER(xy0, zw0);
    *(quad *)(p + 8 * (size_t)i[1]) = LOWER(xy1, zw1);
    *(quad *)(p + 8 * (size_t)i[2]) = UPPER(xy0, zw0);
    *(quad *)(p + 8 * (size_t)i[3]) = UPPER(xy1, zw1);
#endif
}

// How the contact plane has turned in the last time step.
struct turning {
    struct lanes3 normal;
    struct lanes3 middle; // n - t/2
    lanes spin;           // a, about n
    lanes shrink;         // 1 - a^2/2
};

INLINE struct lanes3 turn(struct turning by, struct lanes3 f)
{
    const struct lanes3 flat = subtract3(f, scale3(dot3(f, by.normal), by.middle));
    return add3(scale3(by.shrink, flat), scale3(by.spin, cross3(by.normal, flat)));
}

// How a group of pairs lies and moves [K 4.7-4.9, 4.15, 4.17].
struct meeting {
    struct turning turning;
    lanes stretch, overlap;
    lanes first_arm, second_arm; // from the centres to the contact point
    lanes normal_velocity;
    struct lanes3 shear_velocity; // V^s
    struct lanes3 turning_apart;  // omega_j - omega_i
};

INLINE struct meeting meet(const struct pair_group *g, int at,
                           const struct place *place, const struct motion *motion,
                           lanes time_step)
{
    const int32_t *i = g->first + at, *j = g->second + at;
    const struct lanes4 place_i = gather((const double *)place, 4, i);
    const struct lanes4 place_j = gather((const double *)place, 4, j);
    const struct lanes3 velocity_i = gather((const double *)motion, 8, i).xyz;
    const struct lanes3 velocity_j = gather((const double *)motion, 8, j).xyz;
    const struct lanes3 spin_i = gather((const double *)motion + 4, 8, i).xyz;
    const struct lanes3 spin_j = gather((const double *)motion + 4, 8, j).xyz;

    const struct lanes3 apart = subtract3(place_j.xyz, place_i.xyz);
    const struct lanes3 start = load3(g->separation, at);
    const struct lanes3 separation = add3(start, apart);
    const lanes distance = square_root(dot3(separation, separation));
    const lanes inverse = 1.0 / (distance + 1e-300); // n = 0 if they ever coincide
    const struct lanes3 n = scale3(inverse, separation);

    struct meeting m;
    m.stretch =
        dot3(apart, add3(start, separation)) / (distance + load(g->distance + at));
    m.overlap = load(g->overlap + at) - m.stretch;
    m.first_arm = place_i.w - 0.5 * m.overlap;
    m.second_arm = place_j.w - 0.5 * m.overlap;

    const struct lanes3 v = subtract3(velocity_j, velocity_i);
    const struct lanes3 rolling =
        add3(scale3(m.first_arm, spin_i), scale3(m.second_arm, spin_j));
    m.normal_velocity = dot3(v, n);
    const struct lanes3 sideways = subtract3(v, scale3(m.normal_velocity, n));
    m.shear_velocity = subtract3(sideways, cross3(rolling, n));
    m.turning_apart = subtract3(spin_j, spin_i);

    m.turning.normal = n;
    m.turning.middle = subtract3(n, scale3(0.5 * time_step * inverse, sideways));
    m.turning.spin = 0.5 * time_step * dot3(add3(spin_i, spin_j), n);
    m.turning.shrink = 1.0 - 0.5 * m.turning.spin * m.turning.spin;
    return m;
}

// What a pair feels: along n, in the contact plane, and moments carried by the bond.
struct pair_load {
    lanes normal;
    struct lanes3 shear;
    struct lanes3 moment;
};

// Contact and dashpots [K 4.11-4.16, 4.25-4.30]; TOUCH and HELD (by a bond) are masks.
INLINE struct pair_load contact_load(struct pair_group *g, int at,
                                     const struct meeting *m, mask touch, mask held,
                                     const struct contact_law *law, double time_step)
{
    const lanes zero = {0};
    const lanes spring = only_where(touch, law->normal_stiffness * m->overlap);
    struct lanes3 shear = turn(m->turning, load3(g->shear_force, at));
    shear = subtract3(
        shear, scale3(zero + law->shear_stiffness * time_step, m->shear_velocity));
    shear = only_where3(touch, shear);

    const lanes limit = law->friction * spring;
    const lanes square = dot3(shear, shear);
    const mask slips = square > limit * limit;
    if (any(slips)) {
        const lanes factor = limit / square_root(choose(slips, square, zero + 1.0));
        shear = scale3(choose(slips, factor, zero + 1.0), shear);
    }
    store3(g->shear_force, at, shear);

    const lanes root_mass = load(g->root_mass + at);
    const lanes normal_dashpot = law->normal_damping * root_mass * m->normal_velocity;
    const lanes shear_dashpot = law->shear_damping * root_mass;
    const mask sticks = held | (touch & ~slips);
    return (struct pair_load){
        .normal = spring - only_where(touch | held, normal_dashpot),
        .shear = subtract3(
            shear, scale3(only_where(sticks, shear_dashpot), m->shear_velocity))};
}

// A bond broke in lane LANE: rare. Of two modes in one step the one that is further
// past its strength counts.
static __attribute__((noinline)) void break_bond(struct pair_group *g, int lane,
                                                 bool by_normal, bool by_shear,
                                                 double normal, double shear)
{
    const bool normal_leads =
        normal * g->shear_strength[lane] >= shear * g->normal_strength[lane];
    const bool cracks_in_shear = by_shear && !(by_normal && normal_leads);
    g->crack[lane] = cracks_in_shear ? DEM_CRACK_SHEAR : DEM_CRACK_NORMAL;
    g->normal_strength[lane] = -1;
    g->shear_strength[lane] = -1;
}

// Adds the bonds of the lanes HELD, and breaks them [K 4.31-4.44]. Stresses are
// compared times A R: sigma_max A R = -F^n R + 4 |M^s| as A R^2 = 4 I, and tau_max A R
// = |F^s| R + 2 |M^n| as A R^2 = 2 J. Squares spare the roots.
INLINE int add_bond_load(struct pair_load *total, struct pair_group *g, int at,
                         const struct meeting *m, mask held,
                         const struct contact_law *law, double time_step)
{
    const lanes zero = {0};
    const struct lanes3 n = m->turning.normal;
    const lanes radius = load(g->bond_radius + at);
    const lanes area = M_PI * radius * radius;                   // A
    const lanes bending_inertia = 0.25 * area * radius * radius; // I, and J = 2 I

    const lanes normal = -law->bond_normal_stiffness * area * m->stretch;
    struct lanes3 shear = turn(m->turning, load3(g->bond_shear_force, at));
    shear = subtract3(
        shear, scale3(law->bond_shear_stiffness * time_step * area, m->shear_velocity));

    const lanes twisting = dot3(m->turning_apart, n);
    lanes twist = load(g->bond_twist + at);
    twist -= law->bond_shear_stiffness * time_step * 2.0 * bending_inertia * twisting;
    struct lanes3 bending = turn(m->turning, load3(g->bond_bending, at));
    bending = subtract3(bending,
                        scale3(law->bond_normal_stiffness * time_step * bending_inertia,
                               subtract3(m->turning_apart, scale3(twisting, n))));

    const lanes normal_strength = load(g->normal_strength + at) * area * radius;
    const lanes shear_strength = load(g->shear_strength + at) * area * radius;
    const lanes tension = -normal * radius;
    const lanes bending_left = normal_strength - tension;
    const lanes twist_size = choose(twist < 0.0, -twist, twist);
    const lanes shear_left = shear_strength - 2.0 * twist_size;
    const lanes bending_square = 16.0 * dot3(bending, bending);
    const lanes shear_square = radius * radius * dot3(shear, shear);
    const mask by_normal = held & ((bending_left <= 0.0) |
                                   (bending_square >= bending_left * bending_left));
    const mask by_shear =
        held & ((shear_left <= 0.0) | (shear_square >= shear_left * shear_left));

    const mask broken = by_normal | by_shear;
    int count = 0;
    if (any(broken)) {
        for (int lane = 0; lane < LANES; lane++) {
            if (!broken[lane]) continue;
            const lanes normal_load = tension + square_root(bending_square);
            const lanes shear_load = 2.0 * twist_size + square_root(shear_square);
            break_bond(g, at + lane, by_normal[lane], by_shear[lane], normal_load[lane],
                       shear_load[lane]);
            count++;
        }
        held &= ~broken;
    }

    shear = only_where3(held, shear);
    bending = only_where3(held, bending);
    twist = only_where(held, twist);
    store3(g->bond_shear_force, at, shear);
    store3(g->bond_bending, at, bending);
    store(g->bond_twist + at, twist);
    total->normal += only_where(held, normal);
    total->shear = add3(total->shear, shear);
    total->moment = add3(bending, scale3(zero + twist, n));
    return count;
}

// Minus F_ij and minus what it turns for the first grain, the opposite force for the
// second [K 4.18, 4.21, 4.43, 4.44].
INLINE void put_loads(struct motion *slot, const struct pair_group *g, int at,
                      const struct meeting *m, const struct pair_load *pair)
{
    const struct lanes3 n = m->turning.normal;
    const struct lanes3 force = add3(scale3(pair->normal, n), pair->shear);
    const struct lanes3 torque = cross3(n, pair->shear);
    const struct lanes3 opposite = {-force.x, -force.y, -force.z};
    const struct lanes3 first = add3(scale3(m->first_arm, torque), pair->moment);
    const struct lanes3 first_moment = {-first.x, -first.y, -first.z};
    const struct lanes3 second_moment =
        subtract3(pair->moment, scale3(m->second_arm, torque));
    scatter((double *)slot, g->first_slot + at, opposite);
    scatter((double *)slot + 4, g->first_slot + at, first_moment);
    scatter((double *)slot, g->second_slot + at, force);
    scatter((double *)slot + 4, g->second_slot + at, second_moment);
}

INLINE int sweep_lanes(struct pair_group *g, int at, const struct place *place,
                       const struct motion *motion, struct motion *slot,
                       const struct contact_law *law, double time_step, int *busy)
{
    const lanes zero = {0};
    const struct meeting m = meet(g, at, place, motion, zero + time_step);
    const mask touch = m.overlap >= 0.0;
    const mask held = load(g->normal_strength + at) >= 0.0;
    if (!any(touch | held) && g->idle) return 0;

    struct pair_load total = contact_load(g, at, &m, touch, held, law, time_step);
    total.moment = (struct lanes3){zero, zero, zero};
    int n_broken = 0;
    if (any(held)) n_broken = add_bond_load(&total, g, at, &m, held, law, time_step);
    put_loads(slot, g, at, &m, &total);
    *busy |= any(touch | held);
    return n_broken;
}

int PAIR_SWEEP(struct pair_group *group, int begin, int end, const struct place *place,
               const struct motion *motion, struct motion *slot,
               const struct contact_law *law, double time_step)
{
    int n_broken = 0;
    for (int k = begin; k < end; k++) {
        int busy = 0;
        for (int at = 0; at < PAIRS_IN_GROUP; at += LANES)
            n_broken +=
                sweep_lanes(&group[k], at, place, motion, slot, law, time_step, &busy);
        group[k].idle = !busy;
    }
    return n_broken;
}
