// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts with rigid flats: the law of the pairs, with the grain first, the wall
// second and at rest, and n_ij against the wall's normal. The plane never turns but
// spins with the grain's half, as the mean of the two angular velocities asks [K 4.15].
#include "dem/engine.h"

#include <math.h>

static struct vector slide(struct vector shear, double limit, bool *slips)
{
    const double size = norm(shear);
    *slips = size > limit;
    return *slips ? scale(limit / size, shear) : shear;
}

static void touch_wall(struct dem *dem, struct wall_pair *pair)
{
    const struct contact_law *law = &dem->wall_law;
    const double dt = dem->cycle > 0 ? dem->time_step : 0; // see dem.c
    const struct place *place = &dem->place[pair->particle];
    const struct motion *motion = &dem->motion[pair->particle];
    const struct vector n = scale(-1, dem->wall[pair->wall].normal);
    const double overlap = pair->overlap + dot(as_vector(place->displacement), n);
    struct motion *slot = &dem->slot[pair->slot];
    *slot = (struct motion){{0}, {0}};
    if (!(overlap >= 0)) {
        pair->shear_force = (struct vector){0, 0, 0};
        return;
    }

    const double arm = place->radius - 0.5 * overlap;
    const struct vector spin = as_vector(motion->angular);
    const struct vector v = scale(
        -1, add(as_vector(motion->linear), scale(arm, cross(spin, n)))); // [K 4.17]
    const double normal_velocity = dot(v, n);
    const struct vector sideways = subtract(v, scale(normal_velocity, n));

    const double turn = 0.5 * dt * dot(spin, n);
    struct vector shear = add(scale(1 - 0.5 * turn * turn, pair->shear_force),
                              scale(turn, cross(n, pair->shear_force)));
    shear = subtract(shear, scale(law->shear_stiffness * dt, sideways));
    const double spring = law->normal_stiffness * overlap;
    bool slips;
    shear = slide(shear, law->friction * spring, &slips);
    pair->shear_force = shear;

    const double normal =
        spring - law->normal_damping * pair->root_mass * normal_velocity;
    if (!slips)
        shear = subtract(shear, scale(law->shear_damping * pair->root_mass, sideways));
    const struct vector force = add(scale(normal, n), shear);
    const struct vector moment = scale(arm, cross(n, shear));
    *slot = (struct motion){{-force.x, -force.y, -force.z},
                            {-moment.x, -moment.y, -moment.z}};
}

void sweep_walls(struct dem *dem)
{
    for (int k = 0; k < dem->n_wall_pair; k++)
        touch_wall(dem, &dem->wall_pair[k]);
}
