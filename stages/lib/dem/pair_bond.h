// SPDX-License-Identifier: GPL-3.0-or-later
// Bonds [K 4.31-4.44]; for pair_kernel.h. A parallel bond of radius R has area A = pi
// R^2, I = pi R^4 / 4 and J = 2 I. With stretch, V^s and the relative spin of one step,
//     tension = k^n A (stretch - that of no tension [shrinkage.c]),
//     F^s -= k^s A V^s dt,
//     M^n -= k^s J omega^n dt,            M^s -= k^n I omega^s dt,
// after F^s and M^s were rotated into the new plane. It breaks when
//     sigma = tension / A + beta |M^s| R / I  or  tau = |F^s| / A + beta |M^n| R / J
// reaches a strength. Contact bonds pull with the springs of the contact instead [K
// 4.2].
//
// One pair a lane, as in pair_contact.h. The state of a bond lies in bond_group: R,
// F^s, M^s, M^n along n, and both strengths, for parallel bonds times A R. A broken one
// has R = 0 and strengths of -1. beta is dem->moment_contribution.
//
// The stiffness of a bond is per area, so the increments need R^2 and R^4 only; the
// constants with pi are made once for all bonds (bond_law). Twist has k^s and bending
// k^n, because the fibres of a cylinder are sheared by the one and stretched by the
// other.
//
// Units: R and lengths in mean radii; tension and F^s in stiffness times length; M^s
// and M^n times a length more; k^n and k^s per area, so k^n A is a stiffness. beta is 1
// - moments_left_out (dem.h): 1 is the beam of [K 4.41, 4.42], 0 leaves moments out of
// the stresses.
//
// Trap: twist and bending are sums over steps and drift by rounding; tension is not, as
// it follows from the distance at once. Shear and bending lie in the contact plane of
// the last step and are turned before anything is added.
#include "dem/pair_rolling.h"

#include <math.h>

// Factors of the increments above, the same for all bonds: times R^2 for forces, times
// R^4 for moments. With the time step in them, but for TENSION, which is not an
// increment.
struct bond_law {
    doublew tension, shear, twist, bending;
};

// With A / R^2 = pi, I / R^4 = pi / 4, J / R^4 = pi / 2.
SIMD_INLINE struct bond_law bond_law(const struct dem *dem, doublew time_step)
{
    const doublew along = splat(M_PI * dem->bond_normal_stiffness);
    const doublew across = splat(M_PI * dem->bond_shear_stiffness);
    return (struct bond_law){along, across * time_step, 0.5 * across * time_step,
                             0.25 * along * time_step};
}

// Breaks the bond in lane LANE (rare). Of two modes in one step, the one further past
// its strength counts. By cross multiplication, because a strength may be 0. noinline
// keeps it out of the registers of the sweep. NORMAL and SHEAR are the loads, in the
// units of the strengths. What the bond carried is for the callers to clear.
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

// Breaks the bonds of the lanes BY_NORMAL or BY_SHEAR; returns how many. NORMAL_LOAD
// and SHEAR_LOAD in the units of the strengths in B. Lanes are looked at one by one:
// few bonds break in one cycle, and mostly none.
SIMD_INLINE int break_bonds(struct bond_group *b, int at, maskw by_normal,
                            maskw by_shear, doublew normal_load, doublew shear_load)
{
    int count = 0;
    for (int lane = 0; lane < SIMD_WIDTH; lane++) {
        const bool normal = holds_in(by_normal, lane), shear = holds_in(by_shear, lane);
        if (!normal && !shear) continue;
        break_bond(b, at + lane, normal, shear, normal_load[lane], shear_load[lane]);
        count++;
    }
    return count;
}

// Forces of parallel bonds: tension and twist along n, the others across it. On the
// second grain.
struct bond_forces {
    doublew tension, twist;
    struct vectorw shear, bending;
};

// What the springs of a bond hold, and lose when it breaks:
//     (tension^2 / (k^n A) + |F^s|^2 / (k^s A) + |M^s|^2 / (k^n I) + (M^n)^2 / (k^s J))
//     / 2.
// SQUARE is R^2. Without a bond (R = 0) it is 0, as spring_loss takes a stiffness of 0
// to hold nothing.
SIMD_INLINE doublew bond_energy(const struct dem *dem, const struct bond_forces *c,
                                doublew square)
{
    const doublew zero = {0};
    const struct vectorw nothing = {zero, zero, zero};
    const double along = M_PI * dem->bond_normal_stiffness;
    const double across = M_PI * dem->bond_shear_stiffness;
    const doublew stretched = along * square, sheared = across * square;
    const doublew bent = 0.25 * stretched * square, twisted = 0.5 * sheared * square;
    return spring_loss((struct vectorw){c->tension, zero, zero}, stretched, nothing,
                       stretched) +
           spring_loss(c->shear, sheared, nothing, sheared) +
           spring_loss(c->bending, bent, nothing, bent) +
           spring_loss((struct vectorw){c->twist, zero, zero}, twisted, nothing,
                       twisted);
}

// Keeps the forces of the lanes WHOLE, clears the others.
SIMD_INLINE void keep_intact(struct bond_forces *c, maskw whole)
{
    c->tension = only_where(whole, c->tension);
    c->twist = only_where(whole, c->twist);
    c->shear = only_where3(whole, c->shear);
    c->bending = only_where3(whole, c->bending);
}

// Breaks the bonds of the lanes BONDED that carry more than they can; returns how many.
// Stresses are compared times A R: sigma A R = tension R + 4 beta |M^s|, as A R^2 = 4
// I, and tau A R = |F^s| R + 2 beta |M^n|, as A R^2 = 2 J. Squares spare the roots. x
// |x| keeps the sign of x: where tension alone is past the strength, left is negative,
// and any bending is at least that.
SIMD_INLINE int break_overloaded(struct bond_forces *c, const struct dem *dem, int k,
                                 int at, maskw bonded, doublew radius)
{
    struct bond_group *g = dem->pairs.bonds + k;
    const doublew square = radius * radius;
    const doublew bending_left =
        fnmadd(c->tension, radius, load(g->normal_strength + at));
    const double beta = dem->moment_contribution;
    const doublew twist_size = magnitude(c->twist);
    const doublew shear_left =
        fnmadd(splat(2 * beta), twist_size, load(g->shear_strength + at));
    const doublew bending_square = 16.0 * beta * beta * dot3(c->bending, c->bending);
    const doublew shear_square = square * dot3(c->shear, c->shear);
    // Also where tension alone exceeds the strength: then the right side is not
    // positive.
    const maskw by_normal =
        both(bonded, at_least(bending_square, bending_left * magnitude(bending_left)));
    const maskw by_shear =
        both(bonded, at_least(shear_square, shear_left * magnitude(shear_left)));
    const maskw broken = either(by_normal, by_shear);
    if (!any(broken)) return 0;
    const doublew normal_load = square_root(bending_square) + c->tension * radius;
    const doublew shear_load = 2.0 * beta * twist_size + square_root(shear_square);
    const int count = break_bonds(g, at, by_normal, by_shear, normal_load, shear_load);
    if (dem->pairs.loss)
        add_to_ledger(dem->pairs.loss[k].broken + at, broken,
                      bond_energy(dem, c, square));
    keep_intact(c, without(bonded, broken));
    return count;
}

// Adds the bonds of the lanes BONDED to TOTAL, and breaks them [K 4.31-4.44]. Lanes
// without a bond have R = 0, so all they add is 0. Tension is subtracted because a
// normal force is positive when it pushes.
SIMD_INLINE int add_bond_load(struct pair_load *total, const struct dem *dem, int k,
                              int at, const struct pair_motion *m, maskw bonded,
                              const struct bond_law *law)
{
    struct bond_group *g = dem->pairs.bonds + k;
    const struct vectorw n = m->rotation.normal;
    const doublew radius = load(g->radius + at), square = radius * radius;
    const doublew fourth = square * square;
    const doublew twisting = dot3(m->relative_spin, n);

    const doublew strained =
        dem->shrinkage ? m->stretch - load(g->free_stretch + at) : m->stretch;
    struct bond_forces c = {
        .tension = law->tension * square * strained,
        .twist = fnmadd(law->twist * fourth, twisting, load(g->twist + at)),
        .shear = rotate_history(m->rotation, load3(g->shear_force, at),
                                FEATURE_PARALLEL_BOND),
        .bending =
            rotate_history(m->rotation, load3(g->bending, at), FEATURE_PARALLEL_BOND)};
    c.shear = subtract_scaled3(c.shear, law->shear * square, m->shear_velocity);
    c.bending = subtract_scaled3(c.bending, law->bending * fourth,
                                 subtract_scaled3(m->relative_spin, twisting, n));
    const int count = break_overloaded(&c, dem, k, at, bonded, radius);

    store3(g->shear_force, at, c.shear);
    store3(g->bending, at, c.bending);
    store(g->twist + at, c.twist);
    total->normal -= c.tension;
    total->shear = add3(total->shear, c.shear);
    total->moment = add_scaled3(c.bending, c.twist, n);
    return count;
}

// Contact bonds pull with the springs of the contact; those past a strength break and
// leave what friction allows [K 4.2]:
//     spring = k^n U, negative in tension;  F^s = rotated F^s - k^s dt V^s;
//     breaks when -spring >= normal_strength or |F^s| >= shear_strength.
// BONDED loses the lanes that broke, LAW gets the spring also in tension. Returns how
// many broke. The trial shear force is found here once more, before contact_load does
// it, because a bond must break before friction is applied to it. The strengths are
// forces. Squares of shear forces are compared: a strength of 0 is reached without a
// load, INFINITY never.
SIMD_INLINE int break_contact_bonds(struct lane_law *law, const struct dem *dem, int k,
                                    int at, const struct pair_motion *m, maskw touch,
                                    maskw *bonded, doublew time_step, unsigned features)
{
    const doublew zero = {0};
    struct bond_group *g = dem->pairs.bonds + k;
    const doublew stiffness = features & FEATURE_PAIR_LAWS
                                  ? load(dem->pairs.laws[k].normal_stiffness + at)
                                  : splat(dem->law.normal_stiffness);
    const doublew spring = stiffness * m->overlap;
    struct vectorw shear =
        rotate_history(m->rotation, load3(dem->pairs.shear[k].force, at), features);
    shear =
        subtract3(shear, scale3(law->shear_stiffness * time_step, m->shear_velocity));
    const doublew normal_strength = load(g->normal_strength + at);
    const doublew shear_strength = load(g->shear_strength + at);
    const doublew square = dot3(shear, shear);
    const maskw by_normal = both(*bonded, at_least(-spring, normal_strength));
    const maskw by_shear =
        both(*bonded, at_least(square, shear_strength * shear_strength));
    const maskw broken = either(by_normal, by_shear);
    int count = 0;
    if (any(broken)) {
        const doublew shear_load = square_root(square);
        count = break_bonds(g, at, by_normal, by_shear, -spring, shear_load);
        // In tension the shear force is lost too; in compression friction keeps its
        // part.
        const maskw apart = without(broken, touch);
        double(*history)[PAIRS_IN_GROUP] = dem->pairs.shear[k].force;
        const struct vectorw was = load3(history, at);
        const maskw all = at_least(zero, zero);
        store3(history, at, only_where3(without(all, apart), was));
        if (dem->pairs.loss) {
            const struct vectorw nothing = {zero, zero, zero};
            const doublew across = law->shear_stiffness;
            add_to_ledger(dem->pairs.loss[k].broken + at, apart,
                          0.5 * spring * m->overlap +
                              spring_loss(was, across, nothing, across));
        }
        *bonded = without(*bonded, broken);
    }
    law->spring = only_where(either(touch, *bonded), spring);
    return count;
}
