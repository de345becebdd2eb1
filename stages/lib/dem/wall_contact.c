// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of a grain with a rigid wall: the law of the pairs, with the grain first and
// the wall second. With n towards the wall, v the velocity of the wall's surface
// relative to the grain's [K 4.17], U the overlap and F^s the history,
//     force on the wall = (k U - c v.n) n + F^s - c_s v_s,   |F^s| <= friction times k
//     U,
// less the pull of a liquid bridge along n, and the grain feels the opposite. Pairs of
// grains rotate their history by velocities (pair_kinematics.h); that of a wall goes
// from the old normal to the new one, as walls may be curved and grains may pass an
// edge.
#include "dem/engine.h"

#include <math.h>

// Coefficients at OVERLAP > 0, such that the normal force is stiffness times overlap
// with both laws.
static struct contact_law law_at(const struct dem *dem, const struct contact_law *law,
                                 double overlap)
{
    struct contact_law now = *law;
    if (!(dem->features & FEATURE_HERTZ)) return now;
    const double root = sqrt(overlap), fourth_root = sqrt(root);
    now.normal_stiffness *= root;
    now.shear_stiffness *= root;
    now.normal_damping *= fourth_root;
    now.shear_damping *= fourth_root;
    return now;
}

static double shear_energy(const struct dem *dem, const struct wall_pair *pair)
{
    if (!(pair->depth > 0)) return 0;
    const double stiffness = law_at(dem, &pair->law, pair->depth).shear_stiffness;
    return stiffness > 0 ? 0.5 * dot(pair->shear_force, pair->shear_force) / stiffness
                         : 0;
}

static double energy_of_rolling(const struct dem *dem, const struct wall_pair *pair)
{
    if (!(dem->features & FEATURE_ROLLING) || !(pair->depth > 0)) return 0;
    const double stiffness = law_at(dem, &pair->law, pair->depth).normal_stiffness;
    return rolling_energy(&pair->rolling, stiffness, pair->rolling_moment);
}

double wall_pair_energy(const struct dem *dem, const struct wall_pair *pair)
{
    if (!(pair->depth > 0)) return 0;
    const double share = dem->features & FEATURE_HERTZ ? 0.4 : 0.5; // of k U^2
    const double stiffness = law_at(dem, &pair->law, pair->depth).normal_stiffness;
    return share * stiffness * pair->depth * pair->depth + shear_energy(dem, pair) +
           energy_of_rolling(dem, pair);
}

// HISTORY of the last step, a shear force or rolling moment, in the contact plane of
// now: the smallest rotation from the old normal to the new one, then ANGLE about the
// new one [K 4.13-4.15]. It is dropped when the grain passes to another face.
static struct vector rotated(const struct wall_pair *pair, struct vector history,
                             struct vector normal, double angle)
{
    const double cosine = dot(pair->normal, normal);
    if (!(cosine > 0)) return (struct vector){0, 0, 0};
    const struct vector f = history;
    const struct vector flat =
        subtract(f, scale(dot(f, normal) / (1 + cosine), add(pair->normal, normal)));
    return add(scale(1 - 0.5 * angle * angle, flat), scale(angle, cross(normal, flat)));
}

// Factor on the shear force of a Hertz contact that opens: its shear stiffness falls,
// and without the factor the same force would come to hold more energy than was put in.
static double shear_retained(const struct dem *dem, double before, double now)
{
    const bool opens = dem->features & FEATURE_HERTZ && now < before;
    return opens ? sqrt(now / before) : 1;
}

// Advances the history of PAIR, where SLIDE is the shear displacement of the last step
// and LIMIT what friction can carry. Returns whether it slips; adds the energy lost to
// *LOST, if the balance is wanted.
static bool advance_shear(const struct dem *dem, struct wall_pair *pair,
                          const struct wall_geometry *contact, struct vector slide,
                          double angle, double limit, double *lost)
{
    const bool balance = dem->balance_energy;
    if (balance) *lost += shear_energy(dem, pair);
    const struct vector before =
        scale(shear_retained(dem, pair->depth, contact->overlap),
              rotated(pair, pair->shear_force, contact->normal, angle));
    pair->shear_force = before;
    pair->normal = contact->normal;
    pair->depth = contact->overlap;
    if (balance)
        *lost -=
            shear_energy(dem, pair); // turning loses nothing, opening and closing do

    const double stiffness = law_at(dem, &pair->law, contact->overlap).shear_stiffness;
    const struct vector trial = subtract(before, scale(stiffness, slide));
    const double size = norm(trial);
    const bool slips = size >= limit;
    pair->shear_force = size > limit ? scale(limit / size, trial) : trial;
    // The mean force times the slip, exact however long the step.
    if (balance && stiffness > 0)
        *lost +=
            0.5 *
            dot(add(before, pair->shear_force), subtract(trial, pair->shear_force)) /
            stiffness;
    return slips;
}

// Load of a grain on the wall, and the energy lost in this step.
struct push {
    struct vector force;
    struct vector shear; // the part of it across the normal
    struct vector couple;
    double dashpots, slip;
};

// The rolling spring and dashpot of PAIR, of which ANGLE is how far it turned about the
// normal; before its shear force, which takes normal and depth along. Adds to PUSH.
static void resist_rolling(const struct dem *dem, struct wall_pair *pair,
                           const struct wall_geometry *contact, double angle,
                           double normal_force, struct push *push)
{
    const struct vector n = contact->normal;
    const struct vector spin =
        subtract(dem->wall[pair->wall].spin, as_vector(spin_of(dem, pair->particle)));
    const bool hertz = dem->features & FEATURE_HERTZ;
    const double before = fmax(pair->depth, 0), now = contact->overlap;
    const struct wall_rolling step = {
        .turned = rotated(pair, pair->rolling_moment, n, angle),
        .rolling = subtract(spin, scale(dot(spin, n), n)),
        .stiffness_before = law_at(dem, &pair->law, before).normal_stiffness,
        .stiffness = law_at(dem, &pair->law, now).normal_stiffness,
        .retained = shear_retained(dem, before, now),
        .normal_force = normal_force,
        .damping = hertz ? sqrt(sqrt(now)) : 1,
        .time_step = dem->cycle > 0 ? dem->time_step : 0};
    push->couple = advance_wall_rolling(pair, &step, &push->slip, &push->dashpots);
}

// Velocity of the wall's surface relative to the grain's [K 4.17].
static struct vector sliding_velocity(const struct dem *dem,
                                      const struct wall_pair *pair,
                                      const struct wall_geometry *contact)
{
    const struct rigid_wall *wall = &dem->wall[pair->wall];
    const struct vector rolling = scale(
        contact->arm, cross(as_vector(spin_of(dem, pair->particle)), contact->normal));
    return subtract(add(wall->velocity, cross(wall->spin, contact->lever)),
                    add(as_vector(velocity_of(dem, pair->particle)), rolling));
}

static struct push push_wall(const struct dem *dem, struct wall_pair *pair,
                             const struct wall_geometry *contact, struct vector v)
{
    const bool turns = dem->features & FEATURE_ROTATION;
    const double dt = dem->cycle > 0 ? dem->time_step : 0; // see dem.c
    const struct contact_law law = law_at(dem, &pair->law, contact->overlap);
    const struct vector n = contact->normal;
    const double normal_velocity = dot(v, n);
    const struct vector sideways = subtract(v, scale(normal_velocity, n));
    const double spring = law.normal_stiffness * contact->overlap;
    const double damping = -law.normal_damping * normal_velocity;
    const double dashpot = dem->no_tensile_damping ? fmax(damping, -spring) : damping;

    struct push push = {.force = scale(spring + dashpot, n)};
    push.dashpots = -dashpot * normal_velocity * dt;
    if (!turns) {
        pair->depth = contact->overlap;
        return push;
    }
    const struct vector spins =
        add(as_vector(spin_of(dem, pair->particle)), dem->wall[pair->wall].spin);
    const double angle = 0.5 * dt * dot(spins, n);
    const double friction_normal_force =
        dem->friction_feels_dashpot ? fmax(spring + dashpot, 0) : spring;
    if (dem->features & FEATURE_ROLLING)
        resist_rolling(dem, pair, contact, angle, friction_normal_force, &push);
    const bool slips = advance_shear(dem, pair, contact, scale(dt, sideways), angle,
                                     law.friction * friction_normal_force, &push.slip);
    push.shear = pair->shear_force;
    if (!slips) {
        push.shear = subtract(push.shear, scale(law.shear_damping, sideways));
        push.dashpots += law.shear_damping * dot(sideways, sideways) * dt;
    }
    push.force = add(push.force, push.shear);
    return push;
}

// How much the force on a wall grows in the next step for each unit of its velocity.
static double resistance(const struct dem *dem, const struct wall_pair *pair)
{
    const double tangent = dem->features & FEATURE_HERTZ ? 1.5 : 1;
    const struct contact_law law = law_at(dem, &pair->law, pair->depth);
    return tangent * law.normal_stiffness * dem->time_step + law.normal_damping;
}

// A grain that does not touch the wall forgets its shear force.
static void leave_wall(const struct dem *dem, struct wall_pair *pair, double overlap)
{
    const struct vector none = {0, 0, 0};
    if (dem->balance_energy)
        pair->slip = shear_energy(dem, pair) + energy_of_rolling(dem, pair);
    pair->shear_force = pair->rolling_moment = none;
    pair->depth = overlap;
    pair->load = pair->moment = none;
}

static void touch_wall(struct dem *dem, struct wall_pair *pair)
{
    const struct wall_geometry contact =
        wall_geometry(dem, pair->particle, pair->wall, 0);
    const bool touches = contact.overlap >= 0, wet = walls_are_wet(dem);
    if (!touches && !acts_on_wall(dem, pair) && !wet && !dem->balance_energy) {
        pair->depth = contact.overlap; // nothing else changes
        return;
    }
    pair->resistance = pair->dashpots = pair->slip = pair->bridge_work = 0;
    if (wet) update_wall_bridge(dem, pair, contact.overlap);
    if (!touches) leave_wall(dem, pair, contact.overlap);
    if (!touches && !is_wall_bridged(dem, pair)) return;

    const struct vector v = sliding_velocity(dem, pair, &contact);
    struct push push = {.dashpots = 0};
    if (touches) push = push_wall(dem, pair, &contact, v);
    if (wet)
        push.force = subtract(push.force, scale(pair->bridge_pull, contact.normal));
    // The grain feels the opposite.
    pair->load = scale(-1, push.force);
    pair->moment =
        subtract(scale(-contact.arm, cross(contact.normal, push.shear)), push.couple);
    pair->wall_moment = add(cross(contact.lever, push.force), push.couple);
    if (!touches) push.slip = pair->slip;
    pair->dashpots = push.dashpots;
    pair->slip = push.slip;
    if (touches) pair->resistance = resistance(dem, pair);
    if (wet && dem->cycle > 0)
        pair->bridge_work = pair->bridge_pull * dot(v, contact.normal) * dem->time_step;
}

void touch_walls(struct dem *dem, int begin, int end)
{
    for (int k = begin; k < end; k++)
        touch_wall(dem, &dem->wall_pair[k]);
}
