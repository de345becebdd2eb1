// SPDX-License-Identifier: GPL-3.0-or-later
#include "basics/memory.h"
#include "move.h"

#include <stdlib.h>

// ---- the box ------------------------------------------------------------------------

// ---- flat walls ---------------------------------------------------------------------

// Of the grains beside a wall, along its axis, m.
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

// ---- round walls --------------------------------------------------------------------

static double depth_below(const struct body *body, struct vector x)
{
    return dot(subtract(body_nearest(body, x), x), body_outward(body, x));
}

// Shift and stretch that take grains to where they are now, by least squares.
struct similarity {
    struct vector from, to; // means
    double stretch;
};

static struct similarity find_similarity(const struct packing *before,
                                         const struct packing *after, const bool *which,
                                         const struct body *body)
{
    struct similarity found = {.stretch = 1};
    int count = 0;
    for (int i = 0; i < before->n_particle; i++)
        count += which[i];
    for (int i = 0; i < before->n_particle; i++) {
        if (!which[i]) continue;
        found.from = add(found.from, scale(1.0 / count, before->position[i]));
        found.to = add(found.to, scale(1.0 / count, after->position[i]));
    }
    double spread = 0, grown = 0;
    for (int i = 0; i < before->n_particle; i++)
        for (int axis = 0; axis < 3 && which[i]; axis++) {
            if (!body_is_round(body, axis)) continue;
            const double was =
                component(subtract(before->position[i], found.from), axis);
            const double is = component(subtract(after->position[i], found.to), axis);
            spread += was * was;
            grown += was * (is - was);
        }
    if (spread > 0) found.stretch += grown / spread;
    return found;
}

static void move_round(const struct packing *before, double diameter,
                       const struct packing *after, struct body *body)
{
    bool *beside = NEW_ARRAY(bool, before->n_particle);
    for (int i = 0; i < before->n_particle; i++)
        beside[i] = depth_below(body, before->position[i]) <= diameter;
    const struct similarity found = find_similarity(before, after, beside, body);
    for (int side = 0; side < WALL_COUNT; side++) {
        const int axis = side / 2;
        struct vector *corner = side % 2 ? &body->upper : &body->lower;
        const double at = component(*corner, axis), from = component(found.from, axis);
        const double moved = component(found.to, axis) - from;
        if (body_is_round(body, axis))
            set_component(corner, axis,
                          at + (moved + (found.stretch - 1) * (at - from)));
    }
    free(beside);
}

// Where a side of the box is that of the body, it goes with its round wall, and flat
// ends of the body with the box.
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
        if (body_is_round(was, axis))
            set_component(corner, axis, component(*to, axis));
        else
            set_component(to, axis, component(*corner, axis));
    }
}

void move_box(const struct packing *before, struct packing *after)
{
    double diameter = 0;
    for (int i = 0; i < before->n_particle; i++)
        diameter += 2 * before->radius[i] / before->n_particle;
    move_walls(before, diameter, after);
    for (int k = 0; k < after->n_body; k++) {
        move_round(before, diameter, after, &after->body[k]);
        join_sides(before, k, after);
    }
}
