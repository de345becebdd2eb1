// SPDX-License-Identifier: GPL-3.0-or-later
// Bonds, parallel ones and those of contacts; for pair_kernel.h.
#include "dem/pair_contact.h"

#include <math.h>

// What the stiffness of parallel bonds makes of a stretch and, in one time step, of
// velocities; times R^2 for forces (A = pi R^2), times R^4 for moments (4 I = 2 J =
// A R^2). The same for all, and kept for all of a sweep.
struct bond_law {
    lanes tension, shear, twist, bending;
};

INLINE struct bond_law bond_law(const struct dem *dem, lanes time_step)
{
    const lanes along = splat(M_PI * dem->bond_normal_stiffness);
    const lanes across = splat(M_PI * dem->bond_shear_stiffness);
    return (struct bond_law){along, across * time_step, 0.5 * across * time_step,
                             0.25 * along * time_step};
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

// Those of the lanes BY_NORMAL or BY_SHEAR; how many.
INLINE int break_bonds(struct bond_group *b, int at, mask by_normal, mask by_shear,
                       lanes normal_load, lanes shear_load)
{
    int count = 0;
    for (int lane = 0; lane < LANES; lane++) {
        const bool normal = holds_in(by_normal, lane), shear = holds_in(by_shear, lane);
        if (!normal && !shear) continue;
        break_bond(b, at + lane, normal, shear, normal_load[lane], shear_load[lane]);
        count++;
    }
    return count;
}

// What parallel bonds carry: tension and twist along n, the others across it.
struct carried {
    lanes tension, twist;
    struct lanes3 shear, bending;
};

// SQUARE is R^2.
INLINE lanes bond_energy(const struct dem *dem, const struct carried *c, lanes square)
{
    const lanes zero = {0};
    const struct lanes3 nothing = {zero, zero, zero};
    const double along = M_PI * dem->bond_normal_stiffness;
    const double across = M_PI * dem->bond_shear_stiffness;
    const lanes stretched = along * square, sheared = across * square;
    const lanes bent = 0.25 * stretched * square, twisted = 0.5 * sheared * square;
    return spring_loss((struct lanes3){c->tension, zero, zero}, stretched, nothing,
                       stretched) +
           spring_loss(c->shear, sheared, nothing, sheared) +
           spring_loss(c->bending, bent, nothing, bent) +
           spring_loss((struct lanes3){c->twist, zero, zero}, twisted, nothing,
                       twisted);
}

// All but in the lanes WHOLE.
INLINE void let_go(struct carried *c, mask whole)
{
    c->tension = only_where(whole, c->tension);
    c->twist = only_where(whole, c->twist);
    c->shear = only_where3(whole, c->shear);
    c->bending = only_where3(whole, c->bending);
}

// Breaks the bonds of the lanes HELD that carry more than they can; how many. Stresses
// are compared times A R: sigma_max A R = -F^n R + 4 beta |M^s| as A R^2 = 4 I,
// and tau_max A R = |F^s| R + 2 beta |M^n| as A R^2 = 2 J. Squares spare the roots.
INLINE int break_overloaded(struct carried *c, const struct dem *dem, int k, int at,
                            mask held, lanes radius)
{
    struct bond_group *g = dem->pairs.bonds + k;
    const lanes square = radius * radius;
    const lanes bending_left =
        less_fused(c->tension, radius, load(g->normal_strength + at));
    const double beta = dem->bond_moments;
    const lanes twist_size = magnitude(c->twist);
    const lanes shear_left =
        less_fused(splat(2 * beta), twist_size, load(g->shear_strength + at));
    const lanes bending_square = 16.0 * beta * beta * dot3(c->bending, c->bending);
    const lanes shear_square = square * dot3(c->shear, c->shear);
    // Also where nothing is left: then the right side is not positive.
    const mask by_normal =
        both(held, at_least(bending_square, bending_left * magnitude(bending_left)));
    const mask by_shear =
        both(held, at_least(shear_square, shear_left * magnitude(shear_left)));
    const mask broken = either(by_normal, by_shear);
    if (!any(broken)) return 0;
    const lanes normal_load = square_root(bending_square) + c->tension * radius;
    const lanes shear_load = 2.0 * beta * twist_size + square_root(shear_square);
    const int count = break_bonds(g, at, by_normal, by_shear, normal_load, shear_load);
    if (dem->pairs.loss)
        book(dem->pairs.loss[k].broken + at, broken, bond_energy(dem, c, square));
    let_go(c, without(held, broken));
    return count;
}

// Adds the bonds of the lanes HELD, and breaks them [K 4.31-4.44].
INLINE int add_bond_load(struct pair_load *total, const struct dem *dem, int k, int at,
                         const struct meeting *m, mask held, const struct bond_law *law)
{
    struct bond_group *g = dem->pairs.bonds + k;
    const struct lanes3 n = m->turning.normal;
    const lanes radius = load(g->radius + at), square = radius * radius;
    const lanes fourth = square * square;
    const lanes twisting = dot3(m->turning_apart, n);

    struct carried c = {
        .tension = law->tension * square * m->stretch,
        .twist = less_fused(law->twist * fourth, twisting, load(g->twist + at)),
        .shear = turn(m->turning, load3(g->shear_force, at), FEATURE_PARALLEL_BOND),
        .bending = turn(m->turning, load3(g->bending, at), FEATURE_PARALLEL_BOND)};
    c.shear = subtract_scaled3(c.shear, law->shear * square, m->shear_velocity);
    c.bending = subtract_scaled3(c.bending, law->bending * fourth,
                                 subtract_scaled3(m->turning_apart, twisting, n));
    const int count = break_overloaded(&c, dem, k, at, held, radius);

    store3(g->shear_force, at, c.shear);
    store3(g->bending, at, c.bending);
    store(g->twist + at, c.twist);
    total->normal -= c.tension;
    total->shear = add3(total->shear, c.shear);
    total->moment = add_scaled3(c.bending, c.twist, n);
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
    struct lanes3 shear =
        turn(m->turning, load3(dem->pairs.shear[k].force, at), features);
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
        count = break_bonds(g, at, by_normal, by_shear, -spring, shear_load);
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
