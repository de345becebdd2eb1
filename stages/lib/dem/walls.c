// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid walls: which grains are near, how they move, and what grains do to them in sum
// (wall_contact.c has the law of the contact). In code order, with the wall's velocity
// v, normal n and time step dt,
//     near:     overlap >= -(half skins of grain and wall + longest gap of a bridge)
//     servo:    v.n = share (wanted - F_n) / resistance, |v.n| <= its largest speed,
//               F_n = -force . n,  resistance = sum over its contacts of k dt + c
//     moves:    displacement += v dt
//     force, moment = sums over its contacts, in the order of the pairs
//     work += dt/2 (-force.v - moment.spin)   with the forces at both ends of a step
// Velocities begin half a step before the first cycle, as those of grains. A spin
// counts as far as it leaves the shape where it is: about the axis of a plane, cylinder
// or ring, any of a sphere, none of a block. Walls go in the scaled units of engine.h.
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
    const double reach = 0.5 * dem->skin + wall_bridge_cutoff(dem);
    int capacity = 0;
    dem->wall_pair = NULL;
    dem->n_wall_pair = 0;
    for (int i = 0; i < dem->n_particle; i++)
        for (int w = 0; w < dem->n_wall && !is_driven(dem, i); w++) {
            const struct wall_geometry contact = wall_geometry(dem, i, w, 0);
            if (!(contact.overlap >= -(reach + dem->half_skin[i]))) continue;
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

// Half of the last time step, over which the forces at each of its ends count.
static double half_step(const struct dem *dem)
{
    return dem->cycle > 0 && dem->balance_energy ? 0.5 * dem->time_step : 0;
}

void begin_walls(struct dem *dem)
{
    if (dem->cycle == 0) start_walls(dem);
    for (int w = 0; w < dem->n_wall; w++) {
        struct rigid_wall *wall = &dem->wall[w];
        book_work(dem, wall, half_step(dem));
        wall->force = wall->moment = (struct vector){0, 0, 0};
        wall->resistance = 0;
    }
}

static void add_up_pair(struct dem *dem, const struct wall_pair *pair)
{
    struct rigid_wall *wall = &dem->wall[pair->wall];
    if (acts_on_wall(dem, pair)) {
        wall->force = subtract(wall->force, pair->load);
        wall->moment = add(wall->moment, pair->wall_moment);
        wall->resistance += pair->resistance;
    }
    if (!dem->balance_energy) return;
    dem->energy_ledger.dashpots += pair->dashpots;
    dem->energy_ledger.slip += pair->slip;
    dem->energy_ledger.bridges += pair->bridge_work;
}

// What walls feel is seen by servos, by the balance, and after the last cycle of a run.
static bool walls_are_seen(const struct dem *dem)
{
    bool servo = false;
    for (int w = 0; w < dem->n_wall; w++)
        servo = servo || dem->wall[w].is.servo_force > 0;
    return servo || dem->balance_energy || dem->keeps_loads;
}

void add_up_walls(struct dem *dem)
{
    if (!walls_are_seen(dem)) return;
    for (int k = 0; k < dem->n_wall_pair; k++)
        add_up_pair(dem, &dem->wall_pair[k]);
    for (int w = 0; w < dem->n_wall; w++)
        book_work(dem, &dem->wall[w], half_step(dem));
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
