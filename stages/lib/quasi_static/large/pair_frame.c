// SPDX-License-Identifier: GPL-3.0-or-later
// The frame of a pair turns with the normal n, which follows the centres, and about n
// with the mean rotation of the two grains. From the last equilibrium on grains i and j
// move by translations x and rotations w; the frame half way gives the midpoint rule:
//     d[NORMAL]  = distance now less distance at the start            (exact)
//     d[SHEAR]  += t . (arc of j about i - (a_i w_i + a_j w_j) x n)
//     d[TORSION], d[BENDING] += n, t . (w_j - w_i)                    [K 4.13-4.17]
// Geometric stiffness: the change of B^T load as the frame turns with the grains, for a
// unit of each of the twelve displacements.
#include "pair_frame.h"

#include <string.h>

static const struct vector none = {0, 0, 0};

struct pair_frame frame_of(const struct contact_pair *pair)
{
    struct pair_frame frame;
    memcpy(frame.axis, pair->axis, sizeof frame.axis);
    memcpy(frame.arm, pair->arm, sizeof frame.arm);
    return frame;
}

void set_frame(struct contact_pair *pair, const struct pair_frame *frame)
{
    memcpy(pair->axis, frame->axis, sizeof frame->axis);
    memcpy(pair->arm, frame->arm, sizeof frame->arm);
}

static bool has_wall(const struct contact_pair *pair)
{
    return pair->grain[1] < 0;
}

static struct vector unit(struct vector a)
{
    return scale(1 / norm(a), a);
}

// The axes of a frame whose normal turns to NORMAL by the smallest rotation, and which
// then turns by SPIN about it.
static void turn_axes(const struct vector *axis, struct vector normal, double spin,
                      struct vector *turned)
{
    const struct vector both = add(axis[0], normal);
    const struct vector flat = subtract(
        axis[1], scale(dot(axis[1], normal) / (1 + dot(axis[0], normal)), both));
    turned[0] = normal;
    turned[1] =
        unit(add(scale(cos(spin), flat), scale(sin(spin), cross(normal, flat))));
    turned[2] = cross(normal, turned[1]);
}

// The motion of a pair since the last equilibrium.
struct relative_motion {
    struct vector bend;    // change of the normal
    double stretch;        // of the distance, since the start
    double closer;         // the part of it since the last equilibrium
    struct vector mean;    // rotation of both grains
    struct vector apart;   // rotation of the second less that of the first
    struct vector rolling; // rotations times arms
};

// Without differences of positions: small displacements keep their digits.
static struct relative_motion motion_of(const struct contact_pair *pair,
                                        const struct pair_motion *pair_motion)
{
    const struct pair_frame *previous = pair_motion->previous;
    const struct displacement still = {none, none};
    const struct displacement i = pair_motion->by[0] ? *pair_motion->by[0] : still;
    const struct displacement j = pair_motion->by[1] ? *pair_motion->by[1] : still;
    struct relative_motion motion = {.mean = scale(0.5, add(i.rotation, j.rotation)),
                                     .apart = subtract(j.rotation, i.rotation)};
    const struct vector *normal = pair_motion->start->axis;
    if (has_wall(pair)) {
        motion.stretch = dot(pair_motion->translation, *normal);
    } else {
        const double from = pair_motion->start->arm[0] + pair_motion->start->arm[1];
        const struct vector start = scale(from, *normal);
        const struct vector now = add(start, pair_motion->translation);
        const double grown = dot(pair_motion->translation, add(start, now));
        motion.stretch = grown / (norm(now) + from);
    }
    motion.closer = motion.stretch - pair->deformation[NORMAL];
    const double half = 0.25 * motion.closer;
    motion.rolling = add(scale(previous->arm[0] + half, i.rotation),
                         scale(previous->arm[1] + half, j.rotation));
    if (has_wall(pair)) return motion;
    const double distance = previous->arm[0] + previous->arm[1] + motion.closer;
    const struct vector shift = subtract(j.translation, i.translation);
    motion.bend =
        scale(1 / distance, subtract(shift, scale(motion.closer, previous->axis[0])));
    return motion;
}

// The path of the second grain about the first: the arc over the chord BEND.
static struct vector arc(const struct relative_motion *motion, double distance)
{
    const double half = fmin(0.5 * norm(motion->bend), 1);
    const double longer = half > 1e-4 ? asin(half) / half : 1 + half * half / 6;
    return scale(longer * distance, motion->bend);
}

void large_deformation(const struct contact_pair *pair,
                       const struct pair_motion *pair_motion,
                       double deformation[COMPONENTS], struct pair_frame *current)
{
    const struct pair_frame *previous = pair_motion->previous;
    const struct relative_motion motion = motion_of(pair, pair_motion);
    const struct vector middle = unit(add(previous->axis[0], scale(0.5, motion.bend)));
    const struct vector normal = unit(add(previous->axis[0], motion.bend));
    struct vector axis[3];
    turn_axes(previous->axis, middle, 0.5 * dot(motion.mean, middle), axis);
    turn_axes(previous->axis, normal, dot(motion.mean, middle), current->axis);
    current->arm[0] = previous->arm[0] + 0.5 * motion.closer;
    current->arm[1] = has_wall(pair) ? 0 : previous->arm[1] + 0.5 * motion.closer;
    const double distance = previous->arm[0] + previous->arm[1] + 0.5 * motion.closer;
    // A wall does not turn with the grain.
    const struct vector across = has_wall(pair)
                                     ? scale(-1, pair_motion->by[0]->translation)
                                     : arc(&motion, distance);
    const struct vector sheared = subtract(across, cross(motion.rolling, middle));
    memcpy(deformation, pair->deformation, sizeof pair->deformation);
    deformation[NORMAL] = motion.stretch;
    for (int k = 0; k < 2; k++)
        deformation[SHEAR + k] += dot(axis[1 + k], sheared);
    for (int k = 0; k < 3; k++)
        deformation[TORSION + k] += dot(axis[k], motion.apart);
}

// ---- stiffness ----------------------------------------------------------------------

// The loads of a pair, in space.
struct carried {
    struct vector force, moment;
    struct vector turning; // normal x shear force
};

static struct carried carried_by(const struct pair_frame *frame,
                                 const double load[COMPONENTS])
{
    const struct vector *axis = frame->axis;
    struct carried carried = {none, none, none};
    for (int k = 0; k < 3; k++) {
        carried.force = add(carried.force, scale(load[k], axis[k]));
        carried.moment = add(carried.moment, scale(load[TORSION + k], axis[k]));
    }
    carried.turning = cross(axis[0], carried.force);
    return carried;
}

// How the loads on both grains change when the second has moved by SHIFT against the
// first, and their rotations add up to TURN.
static void change_loads(const struct contact_pair *pair,
                         const struct pair_frame *frame, const struct carried *carried,
                         struct vector shift, struct vector turn,
                         struct displacement change[2])
{
    const struct vector n = frame->axis[0];
    const bool wall = has_wall(pair);
    struct vector with = scale(0.5 * dot(n, turn), n); // the pair turns
    if (!wall)
        with = add(with, scale(1 / (frame->arm[0] + frame->arm[1]), cross(n, shift)));
    const double longer[2] = {0.5 * dot(n, shift), wall ? 0 : 0.5 * dot(n, shift)};
    const struct vector force = cross(with, carried->force);
    const struct vector moment = cross(with, carried->moment);
    const struct vector turning = cross(with, carried->turning);
    for (int end = 0; end < 2; end++) {
        const double sign = end ? 1 : -1;
        change[end].translation = scale(sign, force);
        change[end].rotation =
            subtract(subtract(scale(sign, moment), scale(frame->arm[end], turning)),
                     scale(longer[end], carried->turning));
    }
}

void geometric_stiffness(const struct contact_pair *pair,
                         const struct pair_frame *frame, const double load[COMPONENTS],
                         struct pair_stiffness *stiffness)
{
    const struct carried carried = carried_by(frame, load);
    double column[12][12];
    for (int c = 0; c < 12; c++) {
        struct vector shift = none, turn = none;
        if (c % 6 < 3)
            set_component(&shift, c % 6, c < 6 ? -1 : 1);
        else
            set_component(&turn, c % 6 - 3, 1);
        struct displacement change[2];
        change_loads(pair, frame, &carried, shift, turn, change);
        memcpy(column[c], change, sizeof column[c]);
    }
    for (int c = 0; c < 12; c++)
        for (int r = 0; r < 12; r++)
            stiffness->block[r][c] = 0.5 * (column[c][r] + column[r][c]);
}
