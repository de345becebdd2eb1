// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the surfaces that a node with walls' bits lies on. A wall 0..5 of the box holds
// it if the node is on it, to 1e-9 of the diagonal. WALL_OUTER and WALL_INNER have no
// number of their own for each side: of all bodies with that wall the side nearest to
// the node is taken, however far,
//     off = |coordinate - side| of a flat one,
//     off = distance to the nearest point of the round one,
// all extended beyond their edges. So WALLS must not have these two bits for a node
// that lies on no body. A flat side holds the node along its axis and takes it along by
// its own step; a round one is only named, and the caller moves along it.
//
// Walls of the box come last: at an edge with the flat end of a body, which lies in the
// same plane, the step is that of the box.
#include "domain_sides.h"

enum { ROUND_SIDE = WALL_COUNT, SIDE_COUNT };

// Where flat side 0..5 of the body stands along its axis, numbered as walls are; m.
static double corner_of(const struct body *body, int side)
{
    return component(side % 2 ? body->upper : body->lower, side / 2);
}

// Distance from AT to a side of the body, extended beyond its edges, m.
static double off_side(const struct body *body, int side, struct vector at)
{
    if (side < ROUND_SIDE)
        return body_is_round(body, side / 2)
                   ? HUGE_VAL
                   : fabs(component(at, side / 2) - corner_of(body, side));
    if (body->shape == BODY_BOX) return HUGE_VAL;
    return distance(body_nearest_round(body, at), at);
}

// Adds the nearest side among all bodies with this wall.
static void add_body(const struct packing *before, const struct packing *after,
                     int wall, struct vector at, struct domain_sides *sides)
{
    double least = HUGE_VAL;
    int nearest = -1, on = -1;
    for (int k = 0; k < before->n_body; k++) {
        const struct body body = body_near(before, k, at);
        for (int side = 0; side < SIDE_COUNT && body_wall(&body) == wall; side++) {
            const double off = off_side(&body, side, at);
            if (!(off < least)) continue;
            least = off;
            nearest = k;
            on = side;
        }
    }
    if (nearest < 0) return;
    if (on == ROUND_SIDE) {
        sides->round = nearest;
        return;
    }
    sides->held[on / 2] = true;
    sides->step[on / 2] =
        corner_of(&after->body[nearest], on) - corner_of(&before->body[nearest], on);
}

struct domain_sides find_domain_sides(const struct packing *before,
                                      const struct packing *after, unsigned walls,
                                      struct vector at)
{
    const double near = 1e-9 * distance(before->lower, before->upper);
    struct domain_sides sides = {.round = -1};
    for (int wall = WALL_INNER; wall >= WALL_OUTER; wall--)
        if (walls >> wall & 1) add_body(before, after, wall, at, &sides);
    for (int wall = WALL_COUNT - 1; wall >= 0; wall--) {
        const double place = wall_position(before, wall);
        const int axis = wall / 2;
        if (!(walls >> wall & 1) || fabs(component(at, axis) - place) > near) continue;
        sides.held[axis] = true;
        sides.step[axis] = wall_position(after, wall) - place;
    }
    return sides;
}
