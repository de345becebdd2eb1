// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of a grain with a wall: the nearest point of each shape, the normal towards
// it, and the overlap.
//
// With start, moved and now = start + moved the centre relative to the wall's point, a
// plane has overlap = overlap at start - moved.n. A cylinder or sphere of radius a has
//     overlap = overlap at start +- moved.(start + now) / (|start| + |now|),
// inside +, outside -, across the axis. So as between grains, no two large numbers are
// subtracted. Rings and blocks, whose nearest point moves from faces to edges, go by
// positions.
#include "dem/engine.h"

#include <math.h>

// A grain's centre relative to the point of a wall, in the nearest image.
struct relative_position {
    struct vector start; // where both began
    struct vector moved; // since
    struct vector now;   // the sum of the two
};

static struct relative_position position_from_wall(const struct dem *dem, int i, int w,
                                                   double back)
{
    const struct rigid_wall *wall = &dem->wall[w];
    const struct vector u = as_vector(dem->place[i].displacement);
    const struct vector v = as_vector(velocity_of(dem, i));
    struct relative_position s = {
        .start = subtract(dem->start[i], wall->is.point),
        .moved = subtract(subtract(u, wall->displacement),
                          scale(back * dem->time_step, subtract(v, wall->velocity)))};
    for (int axis = 0; axis < 3; axis++) {
        const double period = dem->period[axis];
        if (period <= 0) continue;
        const double start = component(s.start, axis);
        const double now = start + component(s.moved, axis);
        set_component(&s.start, axis, start - period * rint(now / period));
    }
    s.now = add(s.start, s.moved);
    return s;
}

// The part of A normal to the unit vector AXIS.
static struct vector across(struct vector a, struct vector axis)
{
    return subtract(a, scale(dot(a, axis), axis));
}

// Any unit vector normal to the unit vector AXIS.
static struct vector some_perpendicular(struct vector axis)
{
    const struct vector other =
        fabs(axis.x) < 0.6 ? (struct vector){1, 0, 0} : (struct vector){0, 1, 0};
    const struct vector found = across(other, axis);
    return scale(1 / norm(found), found);
}

// How far a grain reached beyond the wall at the start.
struct start_overlap {
    double counts; // given_overlap, less what the grain has shrunk by since
    double rests;  // of it what does not push
};

// REACHED by the radius that the grain had then.
static struct start_overlap start_overlap(const struct dem *dem, int i, double reached)
{
    const double given = given_overlap(dem, reached);
    return (struct start_overlap){given - shrunk_by(dem, i),
                                  dem->unstressed ? fmax(reached, 0) : 0};
}

// The functions below return unit normals towards the wall and set *OVERLAP, the first
// two also *RESTS, as above.

static struct vector plane_contact(const struct dem *dem, int i,
                                   const struct dem_wall *wall,
                                   const struct relative_position *s, double radius,
                                   double *overlap, double *rests)
{
    const struct start_overlap start =
        start_overlap(dem, i, radius - dot(s->start, wall->normal));
    *overlap = start.counts - dot(s->moved, wall->normal);
    *rests = start.rests;
    return scale(-1, wall->normal);
}

static struct vector round_contact(const struct dem *dem, int i,
                                   const struct dem_wall *wall,
                                   const struct relative_position *s, double radius,
                                   double *overlap, double *rests)
{
    const bool is_cylinder = wall->shape == DEM_CYLINDER;
    const struct vector axis = is_cylinder ? wall->normal : (struct vector){0, 0, 1};
    const struct vector start = is_cylinder ? across(s->start, axis) : s->start;
    const struct vector moved = is_cylinder ? across(s->moved, axis) : s->moved;
    const struct vector now = add(start, moved);
    const double before = norm(start), length = norm(now), sum = before + length;
    // length - before, without cancellation
    const double stretch = sum > 0 ? dot(moved, add(start, now)) / sum : 0;
    const double sign = wall->outside ? -1 : 1;
    const struct start_overlap reached =
        start_overlap(dem, i, radius + sign * (before - wall->radius));
    *overlap = reached.counts + sign * stretch;
    *rests = reached.rests;
    return length > 0 ? scale(sign / length, now)
                      : scale(sign, some_perpendicular(axis));
}

// APART is the vector from the centre to the nearest point, or 0 for a centre on a
// shape without an inside; then the normal is OTHERWISE.
static struct vector point_contact(struct vector apart, struct vector otherwise,
                                   double radius, double *overlap)
{
    const double length = norm(apart);
    *overlap = radius - length;
    return length > 0 ? scale(1 / length, apart) : otherwise;
}

static struct vector ring_contact(const struct dem_wall *wall,
                                  const struct relative_position *s, double radius,
                                  double *overlap)
{
    const double height = dot(s->now, wall->normal);
    const struct vector flat = across(s->now, wall->normal);
    const double length = norm(flat);
    const double nearest = fmin(fmax(length, wall->inner_radius), wall->radius);
    const struct vector outward =
        length > 0 ? scale(1 / length, flat) : some_perpendicular(wall->normal);
    const struct vector apart =
        subtract(scale(nearest - length, outward), scale(height, wall->normal));
    return point_contact(apart, scale(-1, wall->normal), radius, overlap);
}

static struct vector block_contact(const struct dem_wall *wall,
                                   const struct relative_position *s, double radius,
                                   double *overlap)
{
    struct vector apart = {0, 0, 0}, inward = {0, 0, 0};
    double depth = INFINITY; // below the nearest face, inside
    for (int axis = 0; axis < 3; axis++) {
        const double x = component(s->now, axis);
        const double room = component(wall->half_edge, axis) - fabs(x);
        if (room < 0) set_component(&apart, axis, x > 0 ? room : -room);
        if (room >= depth) continue;
        depth = room;
        inward = (struct vector){0, 0, 0};
        set_component(&inward, axis, x < 0 ? 1 : -1);
    }
    if (depth < 0) return point_contact(apart, inward, radius, overlap);
    *overlap = radius + depth;
    return inward;
}

struct wall_geometry wall_geometry(const struct dem *dem, int i, int w, double back)
{
    const struct dem_wall *wall = &dem->wall[w].is;
    const double radius = dem->place[i].radius, first = radius + shrunk_by(dem, i);
    const struct relative_position s = position_from_wall(dem, i, w, back);
    struct wall_geometry contact;
    double rests = 0;
    if (wall->shape == DEM_PLANE)
        contact.normal =
            plane_contact(dem, i, wall, &s, first, &contact.overlap, &rests);
    else if (wall->shape == DEM_RING)
        contact.normal = ring_contact(wall, &s, radius, &contact.overlap);
    else if (wall->shape == DEM_BLOCK)
        contact.normal = block_contact(wall, &s, radius, &contact.overlap);
    else
        contact.normal =
            round_contact(dem, i, wall, &s, first, &contact.overlap, &rests);
    contact.arm = radius - 0.5 * (contact.overlap + rests);
    contact.lever = add(s.now, scale(contact.arm, contact.normal));
    return contact;
}
