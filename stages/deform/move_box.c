// SPDX-License-Identifier: GPL-3.0-or-later
// The box and its bodies follow the grains beside them. Along an axis, a wall at w
// moves by
//     m + s (w - x),   s = (m' - m) / (x' - x),
// where x and m are the mean place and displacement of the grains within a diameter of
// it, and x', m' those at the opposite wall. A round body takes the similarity (shift,
// rotation, stretch) that fits the displacements of the grains beside it best: with
// positions a and b about their means before and after, and R from rotation.c,
//     stretch = sum b . R a / sum a . a.
// Too few grains, or grains in one layer, do not determine a stretch: then it is 1.
#include "basics/memory.h"
#include "move.h"
#include "rotation.h"

#include <stdlib.h>
#include <string.h>

// ---- flat walls ---------------------------------------------------------------------

// Mean place and displacement of the grains beside a wall, along its axis, m.
struct layer_of_grains {
    int count;
    double place, moved; // means
};

static struct layer_of_grains beside_wall(const struct packing *before,
                                          const struct packing *after, int wall,
                                          double reach)
{
    struct layer_of_grains layer = {0};
    const int axis = wall / 2;
    for (int i = 0; i < before->n_particle; i++) {
        const double place = component(before->position[i], axis);
        if (fabs(place - wall_position(before, wall)) > reach) continue;
        layer.place += place;
        layer.moved += component(after->position[i], axis) - place;
        layer.count++;
    }
    if (!layer.count) return layer;
    layer.place /= layer.count;
    layer.moved /= layer.count;
    return layer;
}

static void move_walls(const struct packing *before, double diameter,
                       struct packing *after)
{
    for (int wall = 0; wall < WALL_COUNT; wall++) {
        const int axis = wall / 2;
        if (before->periodic[axis]) continue;
        const struct layer_of_grains here = beside_wall(before, after, wall, diameter),
                                     there =
                                         beside_wall(before, after, wall ^ 1, diameter);
        const double at = wall_position(before, wall);
        const double apart = there.place - here.place;
        // A single layer, or none, tells nothing of how the body stretches.
        const bool stretches = here.count && there.count && fabs(apart) > diameter / 2;
        const double stretch = stretches ? (there.moved - here.moved) / apart : 0;
        set_component(wall % 2 ? &after->upper : &after->lower, axis,
                      at + (here.moved + stretch * (at - here.place)));
    }
}

// ---- bodies -------------------------------------------------------------------------

// X in the periodic image that is nearest to the body.
static struct vector to_nearest_body(const struct packing *packing,
                                     const struct body *body, struct vector x)
{
    for (int axis = 0; axis < 3; axis++) {
        if (!packing->periodic[axis]) continue;
        const double edge =
            wall_position(packing, 2 * axis + 1) - wall_position(packing, 2 * axis);
        const double middle =
            (component(body->lower, axis) + component(body->upper, axis)) / 2;
        const double boxes = nearbyint((component(x, axis) - middle) / edge);
        set_component(&x, axis, component(x, axis) - boxes * edge);
    }
    return x;
}

// (n_particle) The caller frees it.
static bool *grains_beside(const struct packing *packing, int k, double reach)
{
    bool *beside = NEW_ARRAY(bool, packing->n_particle);
    for (int i = 0; i < packing->n_particle; i++) {
        const struct vector at = packing->position[i];
        const struct body body = body_near(packing, k, at);
        beside[i] = distance(body_nearest(&body, at), at) <= reach;
    }
    return beside;
}

// The grains beside a body, before and after.
struct grains {
    int count;
    struct vector *was, *is; // (count) off their means, m
    struct vector from, to;  // these means
};

static struct grains motion_beside(const struct packing *before,
                                   const struct packing *after, int k, double reach)
{
    bool *beside = grains_beside(before, k, reach);
    struct grains grains = {.was = NEW_ARRAY(struct vector, before->n_particle),
                            .is = NEW_ARRAY(struct vector, before->n_particle)};
    for (int i = 0; i < before->n_particle; i++) {
        if (!beside[i]) continue;
        const struct vector was =
            to_nearest_body(before, &before->body[k], before->position[i]);
        const struct vector step = subtract(after->position[i], before->position[i]);
        grains.was[grains.count] = was;
        grains.is[grains.count++] = add(was, step);
    }
    for (int i = 0; i < grains.count; i++) {
        grains.from = add(grains.from, scale(1.0 / grains.count, grains.was[i]));
        grains.to = add(grains.to, scale(1.0 / grains.count, grains.is[i]));
    }
    for (int i = 0; i < grains.count; i++) {
        grains.was[i] = subtract(grains.was[i], grains.from);
        grains.is[i] = subtract(grains.is[i], grains.to);
    }
    free(beside);
    return grains;
}

// Moves the body along AXIS, in which it is flat: shift and stretch by least squares.
static void move_flat(const struct grains *grains, int axis, double least,
                      struct body *body)
{
    double was = 0, both = 0;
    for (int i = 0; i < grains->count; i++) {
        const double at = component(grains->was[i], axis);
        was += at * at;
        both += at * component(grains->is[i], axis);
    }
    const double stretch = was > least ? both / was : 1;
    const double from = component(grains->from, axis);
    for (int side = 0; side < 2; side++) {
        struct vector *corner = side ? &body->upper : &body->lower;
        const double at = component(*corner, axis);
        set_component(
            corner, axis,
            at + (component(grains->to, axis) - from + (stretch - 1) * (at - from)));
    }
}

// Moves the body in the plane or space in which it is round: shift, rotation and
// stretch.
static void move_round(const struct grains *grains, double least, struct body *body)
{
    double was = 0;
    struct products products = {0};
    for (int i = 0; i < grains->count; i++) {
        const struct vector at = body_round_part(body, grains->was[i]);
        was += dot(at, at);
        add_products(&products, at, body_round_part(body, grains->is[i]));
    }
    struct rotation rotation = {.cosine = 1, .along = was};
    if (was > least) rotation = find_rotation(&products);
    const double stretch = was > least ? rotation.along / was : 1;
    const struct vector half = scale(0.5, subtract(body->upper, body->lower));
    const struct vector off = subtract(add(body->lower, half), grains->from);
    const struct vector centre =
        add(grains->to, scale(stretch, rotated(&rotation, body_round_part(body, off))));
    for (int axis = 0; axis < 3; axis++) {
        if (!body_is_round(body, axis)) continue;
        const double at = component(centre, axis);
        const double reach = stretch * component(half, axis);
        set_component(&body->lower, axis, at - reach);
        set_component(&body->upper, axis, at + reach);
    }
}

// Moves one body. Grains that hardly spread do not determine a stretch (LEAST).
static void move_body(const struct packing *before, double diameter, int k,
                      struct packing *after)
{
    struct body *body = &after->body[k];
    struct grains grains = motion_beside(before, after, k, diameter);
    const double least = grains.count * diameter * diameter / 16;
    for (int axis = 0; axis < 3 && grains.count; axis++)
        if (!body_is_round(body, axis)) move_flat(&grains, axis, least, body);
    if (grains.count && body->shape != BODY_BOX) move_round(&grains, least, body);
    free(grains.was);
    free(grains.is);
}

// A side of the box that touches a round body around the grains moves with that; flat
// sides of a body that are sides of the box stay so.
static void join_sides(const struct packing *before, int k, struct packing *after)
{
    const struct body *was = &before->body[k];
    struct body *is = &after->body[k];
    for (int side = 0; side < WALL_COUNT; side++) {
        const int axis = side / 2;
        const struct vector *from = side % 2 ? &was->upper : &was->lower;
        struct vector *to = side % 2 ? &is->upper : &is->lower;
        struct vector *corner = side % 2 ? &after->upper : &after->lower;
        if (component(*from, axis) != wall_position(before, side)) continue;
        if (!body_is_round(was, axis))
            set_component(to, axis, component(*corner, axis));
        else if (was->within)
            set_component(corner, axis, component(*to, axis));
    }
}

void move_box(const struct packing *before, struct packing *after)
{
    if (!memcmp(before->position, after->position,
                (size_t)before->n_particle * sizeof *before->position))
        return; // to the bit
    double diameter = 0;
    for (int i = 0; i < before->n_particle; i++)
        diameter += 2 * before->radius[i] / before->n_particle;
    move_walls(before, diameter, after);
    for (int k = 0; k < after->n_body; k++) {
        move_body(before, diameter, k, after);
        join_sides(before, k, after);
    }
}
