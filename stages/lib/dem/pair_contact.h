// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts and dashpots; for pair_kernel.h.
//
// Dashpots act where grains touch or an intact bond holds them: without them a bonded
// pair in tension would ring for ever. While an unbonded contact slides its shear
// dashpot is off, so that a sliding grain feels friction and nothing more. The normal
// one pulls grains that part, unless no_tensile_damping: then F^n >= 0 where no bond
// holds [G 3].
//
// What friction can carry is a share of the normal spring [K 4.25], or of the whole
// normal force while it pushes. A sphere that slides throughout then loses mu times
// what the spring gave, m (1 + e) v, as rigid bodies do, or mu times all that pushed,
// which is more: a damped contact pulls at its end.
//
// A Hertz contact that unloads forgets shear force as its shear stiffness falls, F^s
// times sqrt(U / U_old): with the incremental law alone a loop of loading would give
// energy out of nothing (Elata & Berryman 1996). U_old = U + V^n dt, by leapfrog.
#include "dem/pair_kinematics.h"

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

// The normal force that friction goes by; PUSH is that of spring and dashpot.
INLINE lanes pressing(const struct dem *dem, const struct law *law, lanes push)
{
    if (!dem->friction_feels_dashpot) return law->spring;
    return only_where(above(push, splat(0)), push);
}

// The shear spring of the contact, slip at LIMIT included [K 4.12-4.16, 4.25-4.26];
// SLIPS says where.
INLINE struct lanes3 shear_spring(const struct dem *dem, int k, int at,
                                  const struct meeting *m, const struct law *law,
                                  lanes limit, mask touch, mask held, lanes time_step,
                                  unsigned features, mask *slips)
{
    double(*history)[PAIRS_IN_GROUP] = dem->pairs.shear[k].force;
    const mask acts = features & FEATURE_CONTACT_BOND ? either(touch, held) : touch;
    const struct lanes3 turned = turn(m->turning, load3(history, at), features);
    struct lanes3 kept = dem->pairs.loss ? only_where3(acts, turned) : turned;
    if (features & FEATURE_HERTZ) kept = scale3(law->forget, kept);
    const struct lanes3 trial =
        only_where3(acts, subtract_scaled3(kept, law->shear_stiffness * time_step,
                                           m->shear_velocity));

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
    lanes damped = only_where(either(touch, held), dashpot);
    if (dem->no_tensile_damping)
        damped = choose(without(above(damped, law->spring), held), law->spring, damped);
    struct pair_load load = {.normal = law->spring - damped};
    if (dem->pairs.loss)
        book(dem->pairs.loss[k].dashpots + at, either(touch, held),
             damped * m->normal_velocity * time_step);
    if (!(features & FEATURE_TURN)) return load;

    mask slips;
    const lanes limit = law->friction * pressing(dem, law, load.normal);
    const struct lanes3 shear = shear_spring(dem, k, at, m, law, limit, touch, held,
                                             time_step, features, &slips);
    const mask sticks = either(held, without(touch, slips));
    const lanes damping = only_where(sticks, law->shear_damping);
    load.shear = subtract_scaled3(shear, damping, m->shear_velocity);
    if (dem->pairs.loss)
        book(dem->pairs.loss[k].dashpots + at, sticks,
             damping * dot3(m->shear_velocity, m->shear_velocity) * time_step);
    return load;
}
