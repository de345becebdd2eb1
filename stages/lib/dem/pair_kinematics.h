// SPDX-License-Identifier: GPL-3.0-or-later
// How pairs are placed and move [K 4.7-4.17]; for pair_kernel.h. One pair a lane, in
// scaled units; i is the first grain, j the second, w their spins. In code order:
//     du = u_j - u_i,  s = s0 + du,  n = s / d,
//     U = U0 - stretch,  arm_i = R_i - U/2,  arm_j = R_j - U/2,
//     v = v_j - v_i,  V^n = v.n (positive where they part),
//     V^s = v - V^n n - (arm_i w_i + arm_j w_j) x n,
//     t = (v - V^n n) dt/d,  a = dt/2 (w_i + w_j).n for the rotation below.
// Places are at the present step, velocities and spins half a step behind (leapfrog).
//
// The overlap never is the difference of two large numbers. With s0 = x_j - x_i where
// the grains began, d0 = |s0| and du = u_j - u_i what the displacements add,
//     d^2 - d0^2 = du.(s0 + s),  so  stretch = d - d0 = du.(s0 + s) / (d + d0),
// and U^n = U0 - stretch [K 4.8] has the digits of du however small. The bond's normal
// force is linear in the distance, so its increments [K 4.32, 4.37] are summed at once:
// F^n = -k^n A stretch.
//
// Rotation of the history [K 4.13-4.15]. For a shear force F in the old contact plane F
// x (n_old x n) = n_old (F.n), and leapfrog gives n_old = n - t with t = V_t dt/d from
// the velocity of the last displacement, so the old normal need not be stored. K's
// first-order rotations F - n_old (F.n) and F + a n x F lengthen F a little each time.
// With (n - t/2) for n_old and (1 - a^2/2) F the length holds to fourth order and F
// ends in the new plane exactly.
//
// Errors: stretch and overlap are exact to a few roundings of |du|, however small that
// is; V^s and the rotation are those of leapfrog, of second order in dt. Where two
// centres coincide n is 0 and so is all that follows along it, in place of NAN.
#include "dem/pair_simd.h"

// How the contact plane has turned in the last time step. All that is needed to turn
// any vector of the plane, so that the shear force, bending and rolling moments share
// it. In a step the contact plane turns about the axis n x t by |t| = |V_t| dt/d, and
// about n by `spin`.
struct plane_rotation {
    struct vectorw normal;
    struct vectorw middle; // n - t/2
    doublew spin;          // a, about n
    doublew shrink;        // 1 - a^2/2
};

// F, a vector in the old contact plane, in the new one: with flat = F - (F.n)(n - t/2),
//     (1 - a^2/2) flat + a n x flat.
SIMD_INLINE struct vectorw rotate_history(struct plane_rotation by, struct vectorw f,
                                          unsigned features)
{
    const struct vectorw flat = subtract_scaled3(f, dot3(f, by.normal), by.middle);
    const struct vectorw along = scale3(by.shrink, flat);
    if (features & FEATURE_PARALLEL_BOND) // three of them by the one rotation
        return subtract_cross3(along, flat, scale3(by.spin, by.normal));
    return add_scaled3(along, by.spin, cross3(by.normal, flat));
}

// Whether the contact is as far from one grain's centre as from the other's. Without
// FEATURE_PAIR_LAWS all grains have one radius.
SIMD_INLINE bool has_equal_arms(unsigned features)
{
    return !(features & FEATURE_PAIR_LAWS);
}

// Motion of the pairs [K 4.7-4.9, 4.15, 4.17]. Velocities as in the head: V^n > 0 where
// they part. The arms reach to the middle of the overlap [K 4.9].
struct pair_motion {
    struct plane_rotation rotation;
    doublew stretch, overlap;      // d - d0; U0 - stretch, below 0 apart
    doublew first_arm, second_arm; // from the centres to the contact point
    doublew normal_velocity;
    struct vectorw shear_velocity; // V^s
    struct vectorw relative_spin;  // omega_j - omega_i
};

// The surfaces' velocity at the contact is that of the centres less rolling x n. SUM is
// w_i + w_j, ROLLING is arm_i w_i + arm_j w_j.
struct spin_terms {
    struct vectorw sum, rolling;
    struct vectorw relative; // omega_j - omega_i
};

// Equal arms need only the sum: half the transpositions. SPINS: the angular halves of
// `motion`, records of eight. I, J: scaled indices (pairs.h) of AT and on.
SIMD_INLINE struct spin_terms find_spin_terms(const struct pair_motion *m,
                                              const double *spins, const uint32_t *i,
                                              const uint32_t *j, unsigned features)
{
    const struct rows rows_i = fetch(spins, 8, i), rows_j = fetch(spins, 8, j);
    struct spin_terms s;
    if (features & FEATURE_ROLLING)
        s.relative = transpose(subtract_rows(rows_j, rows_i)).xyz;
    if (has_equal_arms(features)) {
        s.sum = transpose(add_rows(rows_i, rows_j)).xyz;
        s.rolling = scale3(m->first_arm, s.sum);
        return s;
    }
    const struct vectorw spin_i = transpose(rows_i).xyz, spin_j = transpose(rows_j).xyz;
    s.sum = add3(spin_i, spin_j);
    s.rolling = add_scaled3(scale3(m->first_arm, spin_i), m->second_arm, spin_j);
    return s;
}

// The same where APART, omega_j - omega_i, is known. fetch_changes has APART from the
// same loads as the velocities, so only the spin of the first grain is fetched besides.
SIMD_INLINE struct spin_terms find_bonded_spin_terms(const struct pair_motion *m,
                                                     struct vectorw spin_i,
                                                     struct vectorw apart,
                                                     unsigned features)
{
    struct spin_terms s = {.sum = add_scaled3(apart, splat(2), spin_i),
                           .relative = apart};
    s.rolling = has_equal_arms(features)
                    ? scale3(m->first_arm, s.sum)
                    : add_scaled3(scale3(m->first_arm, spin_i), m->second_arm,
                                  add3(spin_i, apart));
    return s;
}

// The part that only rotating grains need: V^s, and how the plane rotates. Middle and
// spin are half of the motion of one time step, as the head derives.
SIMD_INLINE void find_shear_motion(struct pair_motion *m,
                                   const struct spin_terms *spins,
                                   struct vectorw velocity, doublew inverse,
                                   doublew time_step, unsigned features)
{
    const struct vectorw n = m->rotation.normal;
    const struct vectorw sideways = subtract_scaled3(velocity, m->normal_velocity, n);
    m->shear_velocity = features & FEATURE_PARALLEL_BOND
                            ? subtract_cross3(sideways, spins->rolling, n)
                            : subtract3(sideways, cross3(spins->rolling, n));
    m->relative_spin = spins->relative;
    m->rotation.middle = subtract_scaled3(n, 0.5 * time_step * inverse, sideways);
    m->rotation.spin = 0.5 * time_step * dot3(spins->sum, n);
    m->rotation.shrink = 1.0 - 0.5 * m->rotation.spin * m->rotation.spin;
}

// 1/d and 1/(d + d0). A division takes as long as some thirty multiplications, so one
// division serves both.
struct inverses {
    doublew distance, sum;
};

// 1/d = (1 / (d sum)) sum and 1/sum = (1 / (d sum)) d.
SIMD_INLINE struct inverses invert(doublew distance, doublew distance_at_start)
{
    const doublew d = distance + 1e-300; // n = 0 if they ever coincide
    const doublew sum = d + distance_at_start;
    const doublew both = 1.0 / (d * sum);
    return (struct inverses){both * sum, both * d};
}

// Distance of the pairs. PLACE_I and PLACE_J carry the radii as their fourth number.
struct lane_distance {
    struct vectorw separation; // s = x_j - x_i
    doublew inverse;           // 1 / d
    doublew stretch;           // d - d0
    struct rows place_i, place_j;
};

// Distances that changed little, as between bonded grains, need neither square root nor
// division, which would take longer than all else that bonds need: with x = (d^2 -
// d0^2) / d0^2,
//     1 / d = (1 + x)^(-1/2) / d0,  stretch = d0 x ((1 + x)^(1/2) - 1) / x,
// by Taylor series to rounding while |x| is at most SMALL_CHANGE.
#define SMALL_CHANGE 0x1p-11

// Horner's rule: c0 + c1 x + ... + c4 x^4. Four fused operations. The term left out is
// below 2^-53 of the sum while |x| is at most SMALL_CHANGE: 63/256 x^5 is 7e-18 there.
SIMD_INLINE doublew series(doublew x, double c0, double c1, double c2, double c3,
                           double c4)
{
    doublew sum = fmadd(splat(c4), x, splat(c3));
    sum = fmadd(sum, x, splat(c2));
    sum = fmadd(sum, x, splat(c1));
    return fmadd(sum, x, splat(c0));
}

// For any distance: stretch = (d^2 - d0^2) / (d + d0).
SIMD_INLINE void find_stretch(struct lane_distance *pair, doublew square_change,
                              doublew distance_at_start)
{
    const doublew distance = square_root(dot3(pair->separation, pair->separation));
    const struct inverses inverses = invert(distance, distance_at_start);
    pair->inverse = inverses.distance;
    pair->stretch = square_change * inverses.sum;
}

// Lanes beyond the series are found in the other way, and all lanes pay for it then.
// `not_at_most` sends NAN there, too.
SIMD_INLINE void find_small_stretch(struct lane_distance *pair, doublew square_change,
                                    const struct pair_group *g, int at)
{
    const doublew inverse = load(g->inverse_distance + at);
    const doublew by_distance = square_change * inverse, x = by_distance * inverse;
    const maskw large = not_at_most(magnitude(x), splat(SMALL_CHANGE));
    struct lane_distance small = *pair;
    small.inverse = inverse * series(x, 1, -1. / 2, 3. / 8, -5. / 16, 35. / 128);
    small.stretch =
        by_distance * series(x, 1. / 2, -1. / 8, 1. / 16, -5. / 128, 7. / 256);
    if (any(large)) {
        find_stretch(pair, square_change, load(g->distance + at));
        small.inverse = choose(large, pair->inverse, small.inverse);
        small.stretch = choose(large, pair->stretch, small.stretch);
    }
    pair->inverse = small.inverse;
    pair->stretch = small.stretch;
}

// Of x_j - x_i = s0 + (u_j - u_i), never of two positions.
SIMD_INLINE struct lane_distance find_distance(const struct dem *dem, int k, int at,
                                               unsigned features)
{
    const struct pair_group *g = dem->pairs.group + k;
    const double *places = (const double *)dem->place;
    struct lane_distance pair = {.place_i = fetch(places, 4, g->first + at),
                                 .place_j = fetch(places, 4, g->second + at)};
    const struct vectorw apart =
        transpose(subtract_rows(pair.place_j, pair.place_i)).xyz;
    const struct vectorw start = load3(g->separation, at);
    pair.separation = add3(start, apart);
    const doublew square_change =
        dot3(apart, add3(start, pair.separation)); // d^2 - d0^2
    if (features & FEATURE_PARALLEL_BOND)
        find_small_stretch(&pair, square_change, g, at);
    else
        find_stretch(&pair, square_change, load(g->distance + at));
    return pair;
}

// All of the above for lanes AT .. AT + SIMD_WIDTH - 1 of group K. Without
// FEATURE_ROTATION shear velocity, relative spin and rotation but its normal are not
// set.
SIMD_INLINE struct pair_motion find_pair_motion(const struct dem *dem, int k, int at,
                                                doublew time_step, unsigned features)
{
    const struct lane_distance pair = find_distance(dem, k, at, features);
    const struct pair_group *g = dem->pairs.group + k;
    const uint32_t *i = reload_pointer(g->first + at),
                   *j = reload_pointer(g->second + at);
    const size_t stride = features & FEATURE_ROTATION ? 8 : 4;
    struct vectorw velocity, apart;
    if (features & FEATURE_PARALLEL_BOND)
        fetch_changes(dem->velocity, i, j, &velocity, &apart);
    else
        velocity = transpose(subtract_rows(fetch(dem->velocity, stride, j),
                                           fetch(dem->velocity, stride, i)))
                       .xyz;
    struct pair_motion m = {.stretch = pair.stretch};
    m.rotation.normal = scale3(pair.inverse, pair.separation);
    m.overlap = load(g->overlap + at) - m.stretch;
    const doublew radius = splat(dem->place[0].radius); // of all, unless they differ
    const bool differ = features & FEATURE_PAIR_LAWS;
    const doublew first_radius = differ ? transpose(pair.place_i).w : radius;
    const doublew second_radius = differ ? transpose(pair.place_j).w : radius;
    // Arms that together are the distance, also where an overlap does not push.
    const doublew shared = dem->unstressed ? first_radius + second_radius -
                                                 load(g->distance + at) - m.stretch
                                           : m.overlap;
    m.first_arm = first_radius - 0.5 * shared;
    m.second_arm =
        has_equal_arms(features) ? m.first_arm : second_radius - 0.5 * shared;
    m.normal_velocity = dot3(velocity, m.rotation.normal);
    if (!(features & FEATURE_ROTATION)) return m;
    const struct spin_terms spins =
        features & FEATURE_PARALLEL_BOND
            ? find_bonded_spin_terms(
                  &m, transpose(fetch(dem->spin, 8, reload_pointer(i))).xyz, apart,
                  features)
            : find_spin_terms(&m, dem->spin, i, j, features);
    find_shear_motion(&m, &spins, velocity, pair.inverse, time_step, features);
    return m;
}
