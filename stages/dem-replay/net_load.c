// SPDX-License-Identifier: GPL-3.0-or-later
#include "net_load.h"

#include <math.h>

// Mass in units of the first grain's; lengths below in units of its radius.
static double mass_of(const struct packing *packing, int i)
{
    return pow(packing->radius[i] / packing->radius[0], 3);
}

static struct vector place_of(const struct packing *packing, int i,
                              struct vector origin)
{
    return scale(1 / packing->radius[0], subtract(packing->position[i], origin));
}

static struct vector centre_of_mass(const struct packing *packing, double *mass)
{
    struct vector sum = {0};
    *mass = 0;
    for (int i = 0; i < packing->n_particle; i++) { // from one corner: no large numbers
        const struct vector from = subtract(packing->position[i], packing->lower);
        sum = add(sum, scale(mass_of(packing, i), from));
        *mass += mass_of(packing, i);
    }
    return add(packing->lower, scale(1 / *mass, sum));
}

// Rows of the inertia tensor sum m (r.r 1 - r r) about ORIGIN.
static void inertia(const struct packing *packing, struct vector origin,
                    struct vector row[3])
{
    row[0] = row[1] = row[2] = (struct vector){0};
    for (int i = 0; i < packing->n_particle; i++) {
        const struct vector r = place_of(packing, i, origin);
        for (int axis = 0; axis < 3; axis++) {
            struct vector part = scale(-component(r, axis), r);
            set_component(&part, axis, component(part, axis) + dot(r, r));
            row[axis] = add(row[axis], scale(mass_of(packing, i), part));
        }
    }
}

// The angular acceleration that MOMENT gives, by Cramer's rule; none for grains in a
// line or at one point, which have no inertia about some axis.
static struct vector angular_acceleration(const struct vector row[3],
                                          struct vector moment)
{
    const struct vector across[3] = {cross(row[1], row[2]), cross(row[2], row[0]),
                                     cross(row[0], row[1])};
    const double determinant = dot(row[0], across[0]);
    const double size = norm(row[0]) + norm(row[1]) + norm(row[2]);
    if (!(determinant > 1e-9 * size * size * size)) return (struct vector){0};
    return scale(1 / determinant,
                 add(scale(moment.x, across[0]),
                     add(scale(moment.y, across[1]), scale(moment.z, across[2]))));
}

void take_off_net_load(const struct packing *packing, struct vector *force)
{
    double mass;
    const struct vector origin = centre_of_mass(packing, &mass);
    struct vector net = {0}, moment = {0}, row[3];
    for (int i = 0; i < packing->n_particle; i++) {
        net = add(net, force[i]);
        moment = add(moment, cross(place_of(packing, i, origin), force[i]));
    }
    inertia(packing, origin, row);
    const struct vector turn = angular_acceleration(row, moment);
    for (int i = 0; i < packing->n_particle; i++) {
        const struct vector push =
            add(scale(1 / mass, net), cross(turn, place_of(packing, i, origin)));
        force[i] = subtract(force[i], scale(mass_of(packing, i), push));
    }
}
