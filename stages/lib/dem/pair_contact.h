// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts and dashpots; for pair_kernel.h. Every doublew has one pair a lane: lanes
// AT .. AT + SIMD_WIDTH - 1 of group K. Scaled units. With U the overlap, n from the
// first grain to the second, V^n > 0 where they part, V^s the shear velocity, per lane:
//     linear: spring = k^n U, and k^s, c^n, c^s as they are;
//     Hertz:  spring = k^n U^1.5, k^s U^0.5, c^n U^0.25, c^s U^0.25;
//     normal = spring - c^n V^n                                [K 4.11, 4.27-4.30]
//     limit  = friction times the normal force that counts     [K 4.25]
//     trial  = rotated F^s - k^s dt V^s                        [K 4.12-4.16]
//     F^s    = trial, or trial limit / |trial| where that slips [K 4.26]
//     shear  = F^s - c^s V^s where it does not slip
// F^s is kept for the next step; normal n and shear act on the second grain. All is 0
// where neither contact nor bond acts (masks `touch`, `bonded`).
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
//
// Steps are explicit: forces at the present places, velocities of half a step before
// (leapfrog). So a dashpot sees the velocity that led here, which stability.c counts in
// the limit of the step. A contact that opens has spring, trial and force 0 in the same
// step: touch is U >= 0, and the history of a pair apart is cleared when it is next
// advanced.
//
// What is not here: the pull of liquid and adhesion (liquid.c, adhesion.c) comes to
// `normal` afterwards and does not limit friction.
#include "dem/pair_kinematics.h"

// Coefficients of a contact at its overlap. The two secant stiffnesses serve rolling
// springs, whose stiffness follows that of the contact.
struct lane_law {
    doublew spring; // normal force
    // At this overlap, as the force.
    doublew shear_stiffness, normal_damping, shear_damping, friction;
    doublew normal_stiffness, normal_stiffness_before; // secant
    // Hertz: factor that the shear force of the step before keeps, and the shear
    // stiffness that it had.
    doublew shear_retained, shear_stiffness_before;
};

// The law of the lanes: spring, stiffness and damping at the overlaps that M has; the
// spring is 0 where grains do not TOUCH. From pairs.laws where pairs differ, else from
// dem->law: the fewer bytes, the faster a large scene. Overlaps of grains that do not
// touch are cleared before the roots: that of a negative number is NAN. Hertz takes
// four roots and a division, linear laws none.
SIMD_INLINE struct lane_law law_at(const struct dem *dem, int k, int at,
                                   const struct pair_motion *m, maskw touch,
                                   doublew time_step, unsigned features)
{
    const struct contact_law *all = &dem->law;
    const struct law_group *laws = dem->pairs.laws + k;
    const bool differ = features & FEATURE_PAIR_LAWS;
    const bool springs = differ && dem->springs_differ;
    const doublew stiffness =
        springs ? load(laws->normal_stiffness + at) : splat(all->normal_stiffness);
    struct lane_law law = {.shear_stiffness = springs ? load(laws->shear_stiffness + at)
                                                      : splat(all->shear_stiffness),
                           .normal_damping = differ ? load(laws->normal_damping + at)
                                                    : splat(all->normal_damping),
                           .shear_damping = differ ? load(laws->shear_damping + at)
                                                   : splat(all->shear_damping),
                           .friction = springs ? load(laws->friction + at)
                                               : splat(all->friction)};
    law.normal_stiffness = law.normal_stiffness_before = stiffness;
    if (!(features & FEATURE_HERTZ)) {
        law.spring = only_where(touch, stiffness * m->overlap);
        law.shear_stiffness_before = law.shear_stiffness;
        return law;
    }
    const doublew overlap = only_where(touch, m->overlap);
    const doublew root = square_root(overlap), fourth = square_root(root);
    const doublew before = m->overlap + time_step * m->normal_velocity;
    const maskw was = above(before, splat(0));
    law.spring = stiffness * overlap * root;
    const doublew root_before = square_root(only_where(was, before));
    law.shear_stiffness_before = law.shear_stiffness * root_before;
    law.normal_stiffness_before *= root_before;
    law.shear_stiffness *= root;
    law.normal_stiffness *= root;
    law.normal_damping *= fourth;
    law.shear_damping *= fourth;
    const maskw unloads = both(was, above(before, overlap));
    law.shear_retained =
        choose(unloads, square_root(overlap / choose(was, before, splat(1))), splat(1));
    return law;
}

// Load of a pair on its second grain: along n (positive pushes), in the contact plane,
// and moments carried by the bond. MOMENT is set only with FEATURE_MOMENT.
struct pair_load {
    doublew normal;
    struct vectorw shear;
    struct vectorw moment;
};

// ENTRY grows by AMOUNT, an energy, in the lanes WHERE; only if the balance is wanted
// (pairs.loss). Each pair has its entry: sums over pairs are made later in one order,
// for any number of threads. ENTRY: eight numbers a group, aligned.
SIMD_INLINE void add_to_ledger(double *entry, maskw where, doublew amount)
{
    store(entry, load(entry) + only_where(where, amount));
}

// Energy that the shear spring loses when its force and stiffness go from BEFORE and
// STIFFNESS_BEFORE to AFTER and STIFFNESS; a stiffness of 0 holds none. Its energy is
// F^2 / (2 k). A Hertz contact that opens goes to a stiffness of 0, and what it still
// held is lost.
SIMD_INLINE doublew spring_loss(struct vectorw before, doublew stiffness_before,
                                struct vectorw after, doublew stiffness)
{
    const doublew had =
        only_where(above(stiffness_before, splat(0)),
                   dot3(before, before) / choose(above(stiffness_before, splat(0)),
                                                 stiffness_before, splat(1)));
    const doublew has = only_where(
        above(stiffness, splat(0)),
        dot3(after, after) / choose(above(stiffness, splat(0)), stiffness, splat(1)));
    return 0.5 * (had - has);
}

// The normal force that limits friction; PUSH is that of spring and dashpot. Not below
// 0: a dashpot that pulls must not turn the limit round.
SIMD_INLINE doublew friction_normal_force(const struct dem *dem,
                                          const struct lane_law *law, doublew push)
{
    if (!dem->friction_feels_dashpot) return law->spring;
    return only_where(above(push, splat(0)), push);
}

// A spring in the contact plane that slips: its stiffness now and at the overlap of the
// step before, the factor that its force keeps when a Hertz contact opens, the velocity
// that stretches it, and the force at which it slips. Shear and rolling use the same
// one, with forces or moments.
struct slipping_spring {
    doublew stiffness, before, retained; // per length or angle; 1
    struct vectorw velocity;             // in the contact plane
    doublew limit;                       // >= 0
};

// One step of such a spring with its HISTORY [K 4.12-4.16, 4.25-4.26]; SLIPS says where
// it does. Compared by squares, so that the root is taken only where some lane slips.
// Radial return: the force keeps the direction of the trial. What slip takes is (trial
// - force) / k, the slip, times the mean of the force before and after. HISTORY is
// overwritten with the force that is returned. With FEATURE_HERTZ it is first made
// smaller by `retained`. A limit of 0 (no friction) leaves no force.
SIMD_INLINE struct vectorw advance_spring(const struct dem *dem, int k, int at,
                                          double (*history)[PAIRS_IN_GROUP],
                                          const struct pair_motion *m,
                                          const struct slipping_spring *spring,
                                          maskw touch, maskw bonded, doublew time_step,
                                          unsigned features, maskw *slips)
{
    const doublew limit = spring->limit;
    const maskw acts = features & FEATURE_CONTACT_BOND ? either(touch, bonded) : touch;
    const struct vectorw turned =
        rotate_history(m->rotation, load3(history, at), features);
    struct vectorw kept = dem->pairs.loss ? only_where3(acts, turned) : turned;
    if (features & FEATURE_HERTZ) kept = scale3(spring->retained, kept);
    const struct vectorw trial = only_where3(
        acts, subtract_scaled3(kept, spring->stiffness * time_step, spring->velocity));

    const doublew square = dot3(trial, trial);
    *slips = above(square, limit * limit);
    if (features & FEATURE_CONTACT_BOND) *slips = without(*slips, bonded);
    struct vectorw force = trial;
    if (any(*slips)) {
        const doublew factor = limit / square_root(choose(*slips, square, splat(1)));
        force = scale3(choose(*slips, factor, splat(1)), trial);
    }
    store3(history, at, force);
    if (dem->pairs.loss) { // what a contact forgot, and what slip took: the mean force
                           // times the slip
        const doublew now = spring->stiffness, before = spring->before;
        const doublew slip = dot3(add3(kept, force), subtract3(trial, force));
        const doublew taken =
            only_where(above(now, splat(0)),
                       0.5 * slip / choose(above(now, splat(0)), now, splat(1)));
        add_to_ledger(dem->pairs.loss[k].slip + at, at_least(splat(0), splat(0)),
                      spring_loss(turned, before, kept, now) + taken);
    }
    return force;
}

// Contact and dashpots [K 4.11-4.16, 4.25-4.30]; TOUCH and BONDED (by a bond) are
// masks. V^n > 0 where they part, so a dashpot that resists parting lowers the force.
// Without FEATURE_ROTATION there is neither friction nor shear.
SIMD_INLINE struct pair_load contact_load(const struct dem *dem, int k, int at,
                                          const struct pair_motion *m, maskw touch,
                                          maskw bonded, const struct lane_law *law,
                                          doublew time_step, unsigned features)
{
    const doublew dashpot = law->normal_damping * m->normal_velocity;
    doublew damped = only_where(either(touch, bonded), dashpot);
    if (dem->no_tensile_damping)
        damped =
            choose(without(above(damped, law->spring), bonded), law->spring, damped);
    struct pair_load load = {.normal = law->spring - damped};
    if (dem->pairs.loss)
        add_to_ledger(dem->pairs.loss[k].dashpots + at, either(touch, bonded),
                      damped * m->normal_velocity * time_step);
    if (!(features & FEATURE_ROTATION)) return load;

    maskw slips;
    const doublew limit = law->friction * friction_normal_force(dem, law, load.normal);
    const struct slipping_spring spring = {
        law->shear_stiffness, law->shear_stiffness_before, law->shear_retained,
        m->shear_velocity, limit};
    const struct vectorw shear =
        advance_spring(dem, k, at, dem->pairs.shear[k].force, m, &spring, touch, bonded,
                       time_step, features, &slips);
    const maskw sticks = either(bonded, without(touch, slips));
    const doublew damping = only_where(sticks, law->shear_damping);
    load.shear = subtract_scaled3(shear, damping, m->shear_velocity);
    if (dem->pairs.loss)
        add_to_ledger(dem->pairs.loss[k].dashpots + at, sticks,
                      damping * dot3(m->shear_velocity, m->shear_velocity) * time_step);
    return load;
}
