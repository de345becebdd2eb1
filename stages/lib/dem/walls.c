// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts with rigid walls: the law of the pairs, with the grain first and the wall
// second. With n towards the wall, v the velocity of the wall's surface relative to the
// grain's [K 4.17], U the overlap and F^s the history,
//     force on the wall = (k U - c v.n) n + F^s - c_s v_s,   |F^s| <= friction times k
//     U,
// and the grain feels the opposite. Pairs of grains rotate their history by velocities
// (pair_kinematics.h); that of a wall goes from the old normal to the new one, as walls
// may be curved and grains may pass an edge.
#include "dem/engine.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- which grains are near ----------------------------------------------------------

void list_walls_of_grains(struct dem *dem)
{
    memset(dem->wall_offset, 0,
           ((size_t)dem->n_particle + 1) * sizeof *dem->wall_offset);
    for (int k = 0; k < dem->n_wall_pair; k++)
        dem->wall_offset[dem->wall_pair[k].particle + 1] = k + 1;
    for (int i = 0; i < dem->n_particle; i++)
        if (dem->wall_offset[i + 1] == 0) dem->wall_offset[i + 1] = dem->wall_offset[i];
}

void find_wall_pairs(struct dem *dem)
{
    struct wall_pair *old = dem->wall_pair;
    const struct wall_pair *last = old, *end = old + dem->n_wall_pair;
    const double reach = dem->skin + wall_bridge_cutoff(dem);
    int capacity = 0;
    dem->wall_pair = NULL;
    dem->n_wall_pair = 0;
    for (int i = 0; i < dem->n_particle; i++)
        for (int w = 0; w < dem->n_wall && !is_driven(dem, i); w++) {
            const struct wall_geometry contact = wall_geometry(dem, i, w, 0);
            if (!(contact.overlap >= -reach)) continue;
            struct wall_pair pair = {.particle = i,
                                     .wall = w,
                                     .law = wall_law(dem, i, &dem->wall[w].is),
                                     .normal = contact.normal,
                                     .depth = contact.overlap};
            while (last < end &&
                   (last->particle < i || (last->particle == i && last->wall < w)))
                last++;
            if (last < end && last->particle == i && last->wall == w) {
                pair.shear_force = last->shear_force;
                pair.normal = last->normal;
                pair.depth = last->depth;
                pair.rolling_moment = last->rolling_moment;
                pair.bridge_volume = last->bridge_volume;
                pair.bridge_rupture = last->bridge_rupture;
                pair.bridge_pull = last->bridge_pull;
            }
            if (dem->features & FEATURE_ROLLING) set_wall_rolling(dem, &pair);
            if (walls_are_wet(dem)) set_wall_bridge_radius(dem, &pair);
            GROW_ARRAY(dem->wall_pair, dem->n_wall_pair, capacity);
            dem->wall_pair[dem->n_wall_pair++] = pair;
        }
    free(old);
    list_walls_of_grains(dem);
    for (int w = 0; w < dem->n_wall; w++)
        dem->wall[w].displacement_at_search = dem->wall[w].displacement;
}

double wall_travel(const struct dem *dem)
{
    double largest_distance = 0;
    for (int w = 0; w < dem->n_wall; w++)
        largest_distance =
            fmax(largest_distance, distance(dem->wall[w].displacement,
                                            dem->wall[w].displacement_at_search));
    return largest_distance;
}

void set_wall_laws(struct dem *dem)
{
    for (int k = 0; k < dem->n_wall_pair; k++) {
        struct wall_pair *pair = &dem->wall_pair[k];
        pair->law = wall_law(dem, pair->particle, &dem->wall[pair->wall].is);
        if (dem->features & FEATURE_ROLLING) set_wall_rolling(dem, pair);
        if (walls_are_wet(dem)) set_wall_bridge_radius(dem, pair);
    }
}

// ---- the contact --------------------------------------------------------------------

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
// *LOST.
static bool advance_shear(const struct dem *dem, struct wall_pair *pair,
                          const struct wall_geometry *contact, struct vector slide,
                          double angle, double limit, double *lost)
{
    *lost += shear_energy(dem, pair);
    const struct vector before =
        scale(shear_retained(dem, pair->depth, contact->overlap),
              rotated(pair, pair->shear_force, contact->normal, angle));
    pair->shear_force = before;
    pair->normal = contact->normal;
    pair->depth = contact->overlap;
    *lost -= shear_energy(dem, pair); // turning loses nothing, opening and closing do

    const double stiffness = law_at(dem, &pair->law, contact->overlap).shear_stiffness;
    const struct vector trial = subtract(before, scale(stiffness, slide));
    const double size = norm(trial);
    const bool slips = size >= limit;
    pair->shear_force = size > limit ? scale(limit / size, trial) : trial;
    // The mean force times the slip, exact however long the step.
    if (stiffness > 0)
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
    const struct vector spin = subtract(dem->wall[pair->wall].spin,
                                        as_vector(dem->motion[pair->particle].angular));
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
    const struct motion *grain = &dem->motion[pair->particle];
    const struct vector rolling =
        scale(contact->arm, cross(as_vector(grain->angular), contact->normal));
    return subtract(add(wall->velocity, cross(wall->spin, contact->lever)),
                    add(as_vector(grain->linear), rolling));
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
        add(as_vector(dem->motion[pair->particle].angular), dem->wall[pair->wall].spin);
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
static void leave_wall(struct dem *dem, struct wall_pair *pair, double overlap)
{
    const struct vector none = {0, 0, 0};
    if (dem->balance_energy)
        dem->energy_ledger.slip +=
            shear_energy(dem, pair) + energy_of_rolling(dem, pair);
    pair->shear_force = pair->rolling_moment = none;
    pair->depth = overlap;
    pair->load = pair->moment = none;
}

static void touch_wall(struct dem *dem, struct wall_pair *pair)
{
    const struct wall_geometry contact =
        wall_geometry(dem, pair->particle, pair->wall, 0);
    const bool touches = contact.overlap >= 0, wet = walls_are_wet(dem);
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
    struct rigid_wall *wall = &dem->wall[pair->wall];
    wall->force = add(wall->force, push.force);
    wall->moment =
        add(wall->moment, add(cross(contact.lever, push.force), push.couple));
    if (touches) wall->resistance += resistance(dem, pair);
    if (!dem->balance_energy) return;
    dem->energy_ledger.dashpots += push.dashpots;
    dem->energy_ledger.slip += push.slip;
    if (wet && dem->cycle > 0)
        dem->energy_ledger.bridges +=
            pair->bridge_pull * dot(v, contact.normal) * dem->time_step;
}

// ---- how walls move -----------------------------------------------------------------

// A servo moves its wall by a quarter of the step that would restore the wanted force
// if the grains stayed. For them it is a dashpot, and a stable one: the recursion of a
// wall, one or three grains and a floor has a spectral radius below 1 up to 0.96 of the
// limit of the time step, and with damping ratios up to 1.5 up to 0.86. Without the
// damping in the divisor, any ratio above 2 omega dt would make it oscillate from step
// to step.
static double servo_speed(const struct rigid_wall *wall)
{
    const double share = 0.25, fastest = wall->is.servo_largest_speed;
    const double friction_normal_force = -dot(wall->force, wall->is.normal);
    const double missing = wall->is.servo_force - friction_normal_force;
    if (!(wall->resistance > 0)) return fastest;
    const double speed = share * missing / wall->resistance;
    return fmax(-fastest, fmin(speed, fastest));
}

// The part of the wanted spin that leaves the shape where it is.
static struct vector surface_spin(const struct dem_wall *wall)
{
    if (wall->shape == DEM_BLOCK) return (struct vector){0, 0, 0};
    if (wall->shape == DEM_SPHERE) return wall->spin;
    return scale(dot(wall->spin, wall->normal), wall->normal);
}

// Velocities of walls begin half a step before the first cycle, as those of grains.
static void start_walls(struct dem *dem)
{
    for (int w = 0; w < dem->n_wall; w++) {
        dem->wall[w].velocity = dem->wall[w].is.velocity;
        dem->wall[w].spin = surface_spin(&dem->wall[w].is);
    }
}

void move_walls(struct dem *dem)
{
    for (int w = 0; w < dem->n_wall; w++) {
        struct rigid_wall *wall = &dem->wall[w];
        const struct vector asked = wall->is.velocity, n = wall->is.normal;
        wall->velocity = asked;
        if (wall->is.servo_force > 0)
            wall->velocity = add(asked, scale(servo_speed(wall) - dot(asked, n), n));
        wall->spin = surface_spin(&wall->is);
        wall->displacement =
            add(wall->displacement, scale(dem->time_step, wall->velocity));
    }
}

// ---- the sweep ---------------------------------------------------------------------

// Power of a wall on the grains at its last velocity.
static double power(const struct rigid_wall *wall)
{
    return -dot(wall->force, wall->velocity) - dot(wall->moment, wall->spin);
}

static void book_work(struct dem *dem, struct rigid_wall *wall, double time)
{
    const double work = time * power(wall);
    dem->energy_ledger.gained += work;
    wall->work += work;
}

void sweep_walls(struct dem *dem)
{
    if (dem->cycle == 0) start_walls(dem);
    const double half =
        dem->cycle > 0 && dem->balance_energy ? 0.5 * dem->time_step : 0;
    // Work over the last time step: the mean of the forces at its two ends.
    for (int w = 0; w < dem->n_wall; w++) {
        struct rigid_wall *wall = &dem->wall[w];
        book_work(dem, wall, half);
        wall->force = wall->moment = (struct vector){0, 0, 0};
        wall->resistance = 0;
    }
    for (int k = 0; k < dem->n_wall_pair; k++)
        touch_wall(dem, &dem->wall_pair[k]);
    for (int w = 0; w < dem->n_wall; w++)
        book_work(dem, &dem->wall[w], half);
}

// ---- from outside ------------------------------------------------------------------

void dem_set_wall_motion(struct dem *dem, int wall, struct vector velocity,
                         struct vector spin)
{
    dem->wall[wall].is.velocity = scale(dem->unit.time / dem->unit.length, velocity);
    dem->wall[wall].is.spin = scale(dem->unit.time, spin);
}

void dem_set_servo(struct dem *dem, int wall, double force)
{
    dem->wall[wall].is.servo_force = force / (dem->unit.stiffness * dem->unit.length);
}

struct dem_wall_state dem_wall_state(const struct dem *dem, int wall)
{
    const struct rigid_wall *of = &dem->wall[wall];
    const double length = dem->unit.length, force = dem->unit.stiffness * length;
    return (struct dem_wall_state){.force = scale(force, of->force),
                                   .moment = scale(force * length, of->moment),
                                   .displacement = scale(length, of->displacement),
                                   .work = force * length * of->work};
}
