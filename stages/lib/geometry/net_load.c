// SPDX-License-Identifier: GPL-3.0-or-later
// The net load of an aggregate that nothing holds, and its removal. In units of one
// radius (`length`), with masses r^3 of the grains that are not gone:
//     force  = sum f_i,   moment = sum (r_i - c) x f_i   about the centre of mass c,
//     inertia = sum m (r.r 1 - r r),   turn = inertia^-1 moment,
//     f_i -= m_i (force / mass + turn x r_i):
// one acceleration and one angular acceleration of all grains. A box that repeats along
// two axes or more allows no rotation, along one only that about this axis; inertias
// that are zero to rounding (grains in a line) are skipped.
#include "geometry/net_load.h"

#include <gsl/gsl_eigen.h>
#include <math.h>

double whole_mass(const struct whole *whole, int grain)
{
    const double radius = whole->packing->radius[grain] / whole->length;
    return whole->is_gone && whole->is_gone[grain] ? 0 : radius * radius * radius;
}

struct vector whole_place(const struct whole *whole, int grain)
{
    struct vector from =
        subtract(whole->packing->position[grain], whole->packing->lower);
    if (whole->displacement) from = add(from, whole->displacement[grain]);
    return subtract(scale(1 / whole->length, from), whole->centre);
}

// The tensor is sum m (r.r 1 - r r).
struct whole whole_of(const struct packing *packing, const bool *is_gone,
                      const struct vector *displacement)
{
    struct whole whole = {.packing = packing,
                          .is_gone = is_gone,
                          .displacement = displacement,
                          .length = packing->n_particle ? packing->radius[0] : 1};
    struct vector sum = {0, 0, 0};
    for (int i = 0; i < packing->n_particle; i++) {
        const double mass = whole_mass(&whole, i);
        sum = add(sum, scale(mass, whole_place(&whole, i)));
        whole.mass += mass;
    }
    if (whole.mass > 0) whole.centre = scale(1 / whole.mass, sum);
    for (int i = 0; i < packing->n_particle; i++) {
        const struct vector r = whole_place(&whole, i);
        const double mass = whole_mass(&whole, i);
        for (int axis = 0; axis < 3; axis++) {
            struct vector part = scale(-component(r, axis), r);
            set_component(&part, axis, component(part, axis) + dot(r, r));
            whole.inertia[axis] = add(whole.inertia[axis], scale(mass, part));
        }
    }
    return whole;
}

// Whether the body may turn about AXIS. In a box that repeats along one axis it turns
// about that one only; along two, about none.
static bool turns_about(const struct packing *packing, int axis)
{
    return !packing->periodic[(axis + 1) % 3] && !packing->periodic[(axis + 2) % 3];
}

struct vector whole_turn(const struct whole *whole, struct vector moment)
{
    double tensor[9], own[3], axes[9];
    for (int k = 0; k < 9; k++) {
        const bool free =
            turns_about(whole->packing, k / 3) && turns_about(whole->packing, k % 3);
        tensor[k] = free ? component(whole->inertia[k / 3], k % 3) : 0;
        if (!turns_about(whole->packing, k / 3)) set_component(&moment, k / 3, 0);
    }
    gsl_matrix_view matrix = gsl_matrix_view_array(tensor, 3, 3);
    gsl_matrix_view vectors = gsl_matrix_view_array(axes, 3, 3);
    gsl_vector_view values = gsl_vector_view_array(own, 3);
    gsl_eigen_symmv_workspace *space = gsl_eigen_symmv_alloc(3);
    gsl_eigen_symmv(&matrix.matrix, &values.vector, &vectors.matrix, space);
    gsl_eigen_symmv_free(space);
    const double size = own[0] + own[1] + own[2];
    struct vector turn = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        const struct vector axis = {axes[k], axes[3 + k], axes[6 + k]};
        if (own[k] > 1e-9 * size)
            turn = add(turn, scale(dot(axis, moment) / own[k], axis));
    }
    return turn;
}

// The moment about the centre of mass.
static struct net_load about_centre(const struct whole *whole,
                                    const struct vector *force)
{
    struct net_load net = {0};
    for (int i = 0; i < whole->packing->n_particle; i++) {
        net.force = add(net.force, force[i]);
        net.moment = add(net.moment, cross(whole_place(whole, i), force[i]));
    }
    return net;
}

static struct net_load about_corner(const struct whole *whole, struct net_load net)
{
    const struct vector moment = add(net.moment, cross(whole->centre, net.force));
    return (struct net_load){net.force, scale(whole->length, moment)};
}

// What stops the grains within the time, and has them at rest from then on.
static struct net_load stopping(const struct whole *whole,
                                const struct moving_grains *now)
{
    struct net_load sum = {0};
    for (int i = 0; i < whole->packing->n_particle; i++) {
        const double mass = whole_mass(whole, i);
        const double r = whole->packing->radius[i] / whole->length;
        const struct vector push = scale(mass, now->velocity[i]);
        const struct vector own =
            scale(0.4 * mass * r * r * whole->length, now->spin[i]);
        sum.force = add(sum.force, push);
        sum.moment = add(sum.moment, add(cross(whole_place(whole, i), push), own));
    }
    const double unit = now->density * 4 * M_PI / 3 * pow(whole->length, 3) / now->time;
    return (struct net_load){scale(unit, sum.force), scale(unit, sum.moment)};
}

// SIGN times NET, about the centre of mass, as one acceleration and one angular
// acceleration of all.
static void spread(const struct whole *whole, struct net_load net, double sign,
                   struct vector *force)
{
    const struct vector turn = whole_turn(whole, net.moment);
    const struct vector push = scale(1 / whole->mass, net.force);
    for (int i = 0; i < whole->packing->n_particle; i++) {
        const struct vector each = add(push, cross(turn, whole_place(whole, i)));
        force[i] = add(force[i], scale(sign * whole_mass(whole, i), each));
    }
}

struct net_load take_off_net_load(const struct packing *packing, const bool *is_gone,
                                  const struct moving_grains *now, struct vector *force)
{
    const struct whole whole =
        whole_of(packing, is_gone, now ? now->displacement : NULL);
    const struct net_load net = about_centre(&whole, force);
    if (whole.mass == 0) return about_corner(&whole, net); // all have left
    const struct net_load stop = now && now->velocity
                                     ? stopping(&whole, now)
                                     : (struct net_load){{0, 0, 0}, {0, 0, 0}};
    const struct net_load off = {add(net.force, stop.force),
                                 add(net.moment, stop.moment)};
    spread(&whole, off, -1, force);
    return about_corner(&whole, net);
}

void put_on_net_load(const struct packing *packing, const bool *is_gone,
                     const struct vector *displacement, struct net_load load,
                     struct vector *force)
{
    const struct whole whole = whole_of(packing, is_gone, displacement);
    if (whole.mass == 0) return;
    const struct vector moment =
        subtract(scale(1 / whole.length, load.moment), cross(whole.centre, load.force));
    spread(&whole, (struct net_load){load.force, moment}, 1, force);
}
