// SPDX-License-Identifier: GPL-3.0-or-later
// How pairs lie and move; for pair_kernel.h.
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
#include "dem/lanes.h"

// How the contact plane has turned in the last time step.
struct turning {
    struct lanes3 normal;
    struct lanes3 middle; // n - t/2
    lanes spin;           // a, about n
    lanes shrink;         // 1 - a^2/2
};

INLINE struct lanes3 turn(struct turning by, struct lanes3 f, unsigned features)
{
    const struct lanes3 flat = subtract_scaled3(f, dot3(f, by.normal), by.middle);
    const struct lanes3 along = scale3(by.shrink, flat);
    if (features & FEATURE_PARALLEL_BOND) // three of them by the one rotation
        return subtract_cross3(along, flat, scale3(by.spin, by.normal));
    return add_scaled3(along, by.spin, cross3(by.normal, flat));
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

// The same where APART, omega_j - omega_i, is known.
INLINE struct spinning bonded_spins_of(const struct meeting *m, struct lanes3 spin_i,
                                       struct lanes3 apart, unsigned features)
{
    struct spinning s = {.sum = add_scaled3(apart, splat(2), spin_i), .apart = apart};
    s.rolling = have_one_arm(features)
                    ? scale3(m->first_arm, s.sum)
                    : add_scaled3(scale3(m->first_arm, spin_i), m->second_arm,
                                  add3(spin_i, apart));
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
    const uint32_t *i = read_anew(g->first + at), *j = read_anew(g->second + at);
    const double *motions = (const double *)dem->motion;
    struct lanes3 velocity, apart;
    if (features & FEATURE_PARALLEL_BOND)
        fetch_changes(motions, i, j, &velocity, &apart);
    else
        velocity =
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
    const struct spinning spins =
        features & FEATURE_PARALLEL_BOND
            ? bonded_spins_of(&m, transpose(fetch(motions + 4, 8, read_anew(i))).xyz,
                              apart, features)
            : spins_of(&m, motions + 4, i, j, features);
    meet_turning(&m, &spins, velocity, lie->inverse, time_step, features);
    return m;
}
