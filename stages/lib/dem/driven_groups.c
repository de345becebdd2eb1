// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of grains that are driven as rigid bodies: they feel forces and do not
// respond.
//
// A group has moved by T, the sum of velocity dt, and turned by theta, the sum of
// spin dt, about its axis a, through a point that moves with it. With r the lever of a
// grain where it began, from that point, its displacement is
//     u = T + sin(theta) a x r + 2 sin^2(theta/2) a x (a x r),
// so places do not drift however many steps a turn takes, and small turns keep their
// digits. Velocities are half a step behind, as those of free grains:
//     v = (u - u of the step before) / dt,   omega = spin a.
//
// Work of a group on the rest in a step, with the loads F and M of the rest on its
// grains:
//     W = - sum of dt/2 [(F before + F after).v + (M before + M after).omega],
// as walls have it (walls.c). Each grain books its own in grain_ledger, so no sum
// depends on the number of threads. A grain's last half of that belongs to a step whose
// second force is not known yet: energy.c leaves it out.
#include "dem/engine.h"

#include "basics/memory.h"

#include <math.h>
#include <string.h>

static struct driven_group *group_of_grain(const struct dem *dem, int i)
{
    return &dem->group[dem->group_of[i] - 1];
}

struct vector group_translation(const struct driven_group *group)
{
    const struct compensated *t = group->translation;
    return (struct vector){compensated_value(t[0]), compensated_value(t[1]),
                           compensated_value(t[2])};
}

// From the point of its group to grain I where both began, in the nearest image.
static struct vector lever_at_start(const struct dem *dem, int i)
{
    struct vector lever = subtract(dem->start[i], group_of_grain(dem, i)->is.point);
    for (int axis = 0; axis < 3; axis++) {
        const double period = dem->period[axis], length = component(lever, axis);
        if (period > 0)
            set_component(&lever, axis, length - period * rint(length / period));
    }
    return lever;
}

// What a turn of given SINE and VERSINE = 1 - cosine about AXIS, a unit vector or 0,
// adds to LEVER.
static struct vector turned_by(struct vector axis, double sine, double versine,
                               struct vector lever)
{
    const struct vector across = cross(axis, lever);
    return add(scale(sine, across), scale(versine, cross(axis, across)));
}

static double versine(double angle)
{
    const double half = sin(0.5 * angle);
    return 2 * half * half;
}

struct vector driven_lever(const struct dem *dem, int i, double angle)
{
    const struct vector axis = group_of_grain(dem, i)->is.axis, start = dem->lever[i];
    return add(start, turned_by(axis, sin(angle), versine(angle), start));
}

// ---- setting up ---------------------------------------------------------------------

// Velocities begin half a step before the first cycle, as those of walls.
static void start_group(struct dem *dem, int g)
{
    struct driven_group *group = &dem->group[g];
    group->velocity = group->is.velocity;
    group->spin = group->is.spin;
    const struct vector spin = scale(group->spin, group->is.axis);
    for (int i = 0; i < dem->n_particle; i++) {
        if (dem->group_of[i] != g + 1) continue;
        const struct vector v = add(group->velocity, cross(spin, dem->lever[i]));
        memcpy(velocity_of(dem, i), &v, sizeof v);
        memcpy(spin_of(dem, i), &spin, sizeof spin);
    }
}

void take_groups(struct dem *dem, const struct dem_setup *setup)
{
    const double length = dem->unit.length, time = dem->unit.time;
    if (setup->n_group == 0) return;
    dem->n_driven = setup->n_group;
    dem->group = NEW_ARRAY(struct driven_group, setup->n_group);
    dem->group_of = NEW_ARRAY(uint8_t, dem->n_particle);
    dem->lever = NEW_ARRAY(struct vector, dem->n_particle);
    for (int i = 0; setup->group_of && i < dem->n_particle; i++)
        dem->group_of[i] = setup->group_of[dem->id[i]];
    for (int g = 0; g < setup->n_group; g++) {
        struct dem_group *is = &dem->group[g].is;
        *is = setup->group[g];
        const double size = norm(is->axis);
        is->axis = size > 0 ? scale(1 / size, is->axis) : is->axis;
        is->point = scale(1 / length, is->point);
        is->velocity = scale(time / length, is->velocity);
        is->spin = size > 0 ? time * is->spin : 0;
    }
}

void start_groups(struct dem *dem)
{
    for (int i = 0; dem->group_of && i < dem->n_particle; i++)
        if (is_driven(dem, i)) dem->lever[i] = lever_at_start(dem, i);
    for (int g = 0; g < dem->n_driven; g++)
        start_group(dem, g);
}

// ---- a cycle ------------------------------------------------------------------------

void advance_groups(struct dem *dem)
{
    const double dt = dem->time_step;
    for (int g = 0; g < dem->n_driven; g++) {
        struct driven_group *group = &dem->group[g];
        group->velocity = group->is.velocity;
        group->spin = group->is.spin;
        for (int axis = 0; axis < 3; axis++)
            compensated_add(&group->translation[axis],
                            dt * component(group->velocity, axis));
        group->moved = group_translation(group);
        compensated_add(&group->angle, dt * group->spin);
        const double angle = compensated_value(group->angle);
        group->sine = sin(angle);
        group->versine = versine(angle);
    }
}

double group_power(const struct dem *dem, int i, const struct motion *load)
{
    return -dot(as_vector(load->linear), as_vector(velocity_of(dem, i))) -
           dot(as_vector(load->angular), as_vector(spin_of(dem, i)));
}

struct max_speed move_driven_grain(struct dem *dem, int i, const struct motion *load)
{
    const struct driven_group *group = group_of_grain(dem, i);
    const double dt = dem->time_step, limit = MAX_STEP / dt;
    struct place *place = &dem->place[i];
    const struct vector u = add(group->moved, turned_by(group->is.axis, group->sine,
                                                        group->versine, dem->lever[i]));
    const struct vector v = scale(1 / dt, subtract(u, as_vector(place->displacement)));
    const struct vector spin = scale(group->spin, group->is.axis);
    const bool turns = dem->features & FEATURE_ROTATION;
    const double rolling = turns ? place->radius * group->spin : 0;
    const double square = dot(v, v);
    if (!(square + rolling * rolling <= limit * limit))
        return (struct max_speed){.valid = false};

    const double half = dem->balance_energy ? 0.5 * dt : 0;
    if (half > 0 && dem->cycle > 0)
        dem->grain_ledger[i][0] += half * group_power(dem, i, load);
    memcpy(velocity_of(dem, i), &v, sizeof v);
    memcpy(spin_of(dem, i), &spin, sizeof spin);
    memcpy(place->displacement, &u, sizeof u);
    if (half > 0) dem->grain_ledger[i][0] += half * group_power(dem, i, load);
    const double half_skin = dem->half_skin[i];
    return (struct max_speed){
        .square = square, .shares = square / (half_skin * half_skin), .valid = true};
}

// ---- from outside -------------------------------------------------------------------

void dem_set_group_motion(struct dem *dem, int group, struct vector velocity,
                          double spin)
{
    struct dem_group *is = &dem->group[group].is;
    is->velocity = scale(dem->unit.time / dem->unit.length, velocity);
    is->spin = norm(is->axis) > 0 ? dem->unit.time * spin : 0;
    if (dem->cycle == 0) start_group(dem, group);
}
