// SPDX-License-Identifier: GPL-3.0-or-later
// Where walls, bodies and images are. With X = upper - lower, the edges of the box,
//     image_offset = image * X,   image_apart = (to - from) + image * X,
// component by component. The difference of the places comes first: seen from the other
// end, every sign turns round and the digits stay.
//
// body_near moves a body by as many boxes as bring its middle nearest to X,
//     boxes = round((x - middle) / edge)    along axes that repeat, else 0.
// A flat end on a side of the box, to 1e-9 of its edge, or beyond it is moved outwards
// by four boxes: the body goes on there, and the side is no end of it. Else a cylinder
// through a box would have a lid in each side, and points near it would be nearest to a
// surface that is not there. Round sides are never stretched: the width along x is the
// diameter.
#include "geometry/packing.h"

#include "basics/memory.h"

#include <math.h>
#include <stdlib.h>

bool is_periodic(const struct packing *packing)
{
    return packing->periodic[0] || packing->periodic[1] || packing->periodic[2];
}

bool is_auxiliary(const struct packing *packing, int grain)
{
    return packing->kind && packing->kind[grain] == GRAIN_AUXILIARY;
}

double wall_position(const struct packing *packing, int wall)
{
    return component(wall % 2 ? packing->upper : packing->lower, wall / 2);
}

struct body body_near(const struct packing *packing, int k, struct vector x)
{
    struct body body = packing->body[k];
    for (int axis = 0; axis < 3; axis++) {
        const double low = component(packing->lower, axis);
        const double high = component(packing->upper, axis), edge = high - low;
        double from = component(body.lower, axis), to = component(body.upper, axis);
        const bool round = body_is_round(&body, axis);
        const double away = component(x, axis) - from - 0.5 * (to - from);
        const double boxes = packing->periodic[axis] ? nearbyint(away / edge) : 0;
        const double slack = 1e-9 * edge;
        if (!round && from <= low + slack) from -= 4 * edge;
        if (!round && to >= high - slack) to += 4 * edge;
        set_component(&body.lower, axis, from + boxes * edge);
        set_component(&body.upper, axis, to + boxes * edge);
    }
    return body;
}

bool packing_is_round_across(const struct packing *packing, int axis)
{
    for (int k = 0; k < packing->n_body; k++)
        if (packing->body[k].within && body_is_round(&packing->body[k], axis))
            return true;
    return false;
}

// Of several bodies with this wall the nearest surface; of equally near ones the first.
// X itself is the answer where there is none.
struct vector nearest_on_wall(const struct packing *packing, int wall, struct vector x)
{
    if (wall < WALL_COUNT) {
        set_component(&x, wall / 2, wall_position(packing, wall));
        return x;
    }
    double least = HUGE_VAL;
    struct vector nearest = x;
    for (int k = 0; k < packing->n_body; k++) {
        const struct body body = body_near(packing, k, x);
        if (body_wall(&body) != wall) continue;
        const struct vector on = body_nearest(&body, x);
        if (distance(on, x) < least) nearest = on;
        least = fmin(least, distance(on, x));
    }
    return nearest;
}

struct vector image_offset(const struct packing *packing, struct image image)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    return (struct vector){image.along[0] * edge.x, image.along[1] * edge.y,
                           image.along[2] * edge.z};
}

struct vector image_apart(const struct packing *packing, struct vector from,
                          struct vector to, struct image image)
{
    return add(subtract(to, from), image_offset(packing, image));
}

static double volume_of(const struct body *body)
{
    static const double share[] = {[BODY_BOX] = 1,
                                   [BODY_CYLINDER] = M_PI / 4,
                                   [BODY_SPHERE] = M_PI / 6,
                                   [BODY_DISC] = M_PI / 4};
    return share[body->shape] * box_volume(subtract(body->upper, body->lower));
}

double packing_domain_volume(const struct packing *packing)
{
    double room = box_volume(subtract(packing->upper, packing->lower)), holes = 0;
    for (int k = 0; k < packing->n_body; k++) {
        if (packing->body[k].within) room = volume_of(&packing->body[k]);
        if (!packing->body[k].within) holes += volume_of(&packing->body[k]);
    }
    return room - holes;
}

double packing_base_area(const struct packing *packing)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    return packing->n_body ? packing_domain_volume(packing) / edge.z : edge.x * edge.y;
}

double depth_in_bodies(const struct packing *packing, struct vector x)
{
    double depth = HUGE_VAL;
    for (int k = 0; k < packing->n_body; k++) {
        const struct body body = body_near(packing, k, x);
        const double apart = norm(subtract(body_nearest(&body, x), x));
        const bool inwards = body_holds(&body, x) == (body.within == 1);
        depth = fmin(depth, inwards ? apart : -apart);
    }
    return depth;
}

double *copy_bond_strengths(const struct packing *packing)
{
    if (!packing->bond_strength) return NULL;
    return duplicate(packing->bond_strength, (size_t)packing->n_bond, sizeof(double));
}

double *scale_bond_strengths(const struct packing *packing, double mean)
{
    if (!packing->bond_strength || isinf(mean)) return NULL;
    double *strength = NEW_ARRAY(double, packing->n_bond);
    for (int b = 0; b < packing->n_bond; b++)
        strength[b] = mean * packing->bond_strength[b];
    return strength;
}

void packing_free(struct packing *packing)
{
    free(packing->position);
    free(packing->radius);
    free(packing->kind);
    free(packing->bond);
    free(packing->bond_strength);
    *packing = (struct packing){0};
}
