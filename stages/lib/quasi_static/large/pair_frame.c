// SPDX-License-Identifier: GPL-3.0-or-later
#include "pair_frame.h"

#include <string.h>

static const struct vector none = {0, 0, 0};

struct lie joint_lie(const struct joint *joint)
{
    struct lie lie;
    memcpy(lie.axis, joint->axis, sizeof lie.axis);
    memcpy(lie.arm, joint->arm, sizeof lie.arm);
    return lie;
}

void lay_joint(struct joint *joint, const struct lie *lie)
{
    memcpy(joint->axis, lie->axis, sizeof lie->axis);
    memcpy(joint->arm, lie->arm, sizeof lie->arm);
}

static bool has_wall(const struct joint *joint)
{
    return joint->grain[1] < 0;
}

static struct vector unit(struct vector a)
{
    return scale(1 / norm(a), a);
}

// The axes across a normal that turns to NORMAL the shortest way, and by SPIN about it.
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

// What the motion since the last equilibrium does to a joint, about its middle.
struct motion {
    struct vector bend;    // change of the normal
    double stretch;        // of the distance, since the start
    double closer;         // the part of it since the last equilibrium
    struct vector mean;    // turn of both grains
    struct vector apart;   // turn of the second less the first
    struct vector rolling; // turns times arms
};

// No difference of two positions: small displacements keep their digits.
static struct motion motion_of(const struct joint *joint, const struct passage *passage)
{
    const struct lie *before = passage->before;
    const struct displacement still = {none, none};
    const struct displacement i = passage->by[0] ? *passage->by[0] : still;
    const struct displacement j = passage->by[1] ? *passage->by[1] : still;
    struct motion motion = {.mean = scale(0.5, add(i.turn, j.turn)),
                            .apart = subtract(j.turn, i.turn)};
    const struct vector *normal = passage->start->axis;
    if (has_wall(joint)) {
        motion.stretch = dot(passage->shift, *normal);
    } else {
        const double from = passage->start->arm[0] + passage->start->arm[1];
        const struct vector start = scale(from, *normal);
        const struct vector now = add(start, passage->shift);
        const double grown = dot(passage->shift, add(start, now));
        motion.stretch = grown / (norm(now) + from);
    }
    motion.closer = motion.stretch - joint->strain[STRAIN_ALONG];
    const double half = 0.25 * motion.closer;
    motion.rolling =
        add(scale(before->arm[0] + half, i.turn), scale(before->arm[1] + half, j.turn));
    if (has_wall(joint)) return motion;
    const double distance = before->arm[0] + before->arm[1] + motion.closer;
    const struct vector way = subtract(j.shift, i.shift);
    motion.bend =
        scale(1 / distance, subtract(way, scale(motion.closer, before->axis[0])));
    return motion;
}

// The way of the second grain about the first: the arc over the chord BEND.
static struct vector arc(const struct motion *motion, double distance)
{
    const double half = fmin(0.5 * norm(motion->bend), 1);
    const double longer = half > 1e-4 ? asin(half) / half : 1 + half * half / 6;
    return scale(longer * distance, motion->bend);
}

void large_strains(const struct joint *joint, const struct passage *passage,
                   double strain[STRAINS], struct lie *now)
{
    const struct lie *before = passage->before;
    const struct motion motion = motion_of(joint, passage);
    const struct vector middle = unit(add(before->axis[0], scale(0.5, motion.bend)));
    const struct vector normal = unit(add(before->axis[0], motion.bend));
    struct vector axis[3];
    turn_axes(before->axis, middle, 0.5 * dot(motion.mean, middle), axis);
    turn_axes(before->axis, normal, dot(motion.mean, middle), now->axis);
    now->arm[0] = before->arm[0] + 0.5 * motion.closer;
    now->arm[1] = has_wall(joint) ? 0 : before->arm[1] + 0.5 * motion.closer;
    const double distance = before->arm[0] + before->arm[1] + 0.5 * motion.closer;
    // A wall lies still: what its grain moves sideways is all of it.
    const struct vector across =
        has_wall(joint) ? scale(-1, passage->by[0]->shift) : arc(&motion, distance);
    const struct vector sheared = subtract(across, cross(motion.rolling, middle));
    memcpy(strain, joint->strain, sizeof joint->strain);
    strain[STRAIN_ALONG] = motion.stretch;
    for (int k = 0; k < 2; k++)
        strain[STRAIN_ACROSS + k] += dot(axis[1 + k], sheared);
    for (int k = 0; k < 3; k++)
        strain[STRAIN_TWIST + k] += dot(axis[k], motion.apart);
}

// ---- stiffness ----------------------------------------------------------------------

// The loads of a joint, in space.
struct carried {
    struct vector force, moment;
    struct vector turning; // normal x shear force
};

static struct carried carried_by(const struct lie *lie, const double load[STRAINS])
{
    const struct vector *axis = lie->axis;
    struct carried carried = {none, none, none};
    for (int k = 0; k < 3; k++) {
        carried.force = add(carried.force, scale(load[k], axis[k]));
        carried.moment = add(carried.moment, scale(load[STRAIN_TWIST + k], axis[k]));
    }
    carried.turning = cross(axis[0], carried.force);
    return carried;
}

// How the loads on both grains change when these are WAY further apart and have turned
// by TURN, both together.
static void change_loads(const struct joint *joint, const struct lie *lie,
                         const struct carried *carried, struct vector way,
                         struct vector turn, struct displacement change[2])
{
    const struct vector n = lie->axis[0];
    const bool wall = has_wall(joint);
    struct vector with = scale(0.5 * dot(n, turn), n); // the joint turns
    if (!wall) with = add(with, scale(1 / (lie->arm[0] + lie->arm[1]), cross(n, way)));
    const double longer[2] = {0.5 * dot(n, way), wall ? 0 : 0.5 * dot(n, way)};
    const struct vector force = cross(with, carried->force);
    const struct vector moment = cross(with, carried->moment);
    const struct vector turning = cross(with, carried->turning);
    for (int end = 0; end < 2; end++) {
        const double sign = end ? 1 : -1;
        change[end].shift = scale(sign, force);
        change[end].turn =
            subtract(subtract(scale(sign, moment), scale(lie->arm[end], turning)),
                     scale(longer[end], carried->turning));
    }
}

void geometric_stiffness(const struct joint *joint, const struct lie *lie,
                         const double load[STRAINS], struct pair_stiffness *stiffness)
{
    const struct carried carried = carried_by(lie, load);
    double column[12][12];
    for (int c = 0; c < 12; c++) {
        struct vector way = none, turn = none;
        if (c % 6 < 3)
            set_component(&way, c % 6, c < 6 ? -1 : 1);
        else
            set_component(&turn, c % 6 - 3, 1);
        struct displacement change[2];
        change_loads(joint, lie, &carried, way, turn, change);
        memcpy(column[c], change, sizeof column[c]);
    }
    for (int c = 0; c < 12; c++)
        for (int r = 0; r < 12; r++)
            stiffness->block[r][c] = 0.5 * (column[c][r] + column[r][c]);
}
