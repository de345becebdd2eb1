// SPDX-License-Identifier: GPL-3.0-or-later
// Volume and surfaces of one throat: the double cone of a facet and the two pore
// centres, minus the grains in it [C 2.2.2, Figs. 4 and 5].
//     volume  = 1/3 area . step - sum over grains of R surface / 3,
//     surface = R^2 (solid angle at the grain between facet and both centres),
//     sector  = R^2 angle / 2 - segment that sticks out beyond the opposite side.
// With a signed solid angle all throats partition the void exactly. Walls are spheres
// of unlimited radius, so their limits are used: a facet with one wall is a trapezium
// down to it, with two walls a rectangle to the edge of the box, and a wall's surface
// is plane.
#include "facet.h"

#include "geometry/solid_angle.h"

// Solid angle at a grain between the directions U and V of the facet's other corners
// and both centres.
static double solid_angle_at(struct vector u, struct vector v, struct vector from,
                             struct vector to, bool partition)
{
    if (partition)
        return solid_angle_between(half_solid_angle(u, v, from),
                                   half_solid_angle(u, v, to));
    const struct half_angle none = {1, 0};
    return fabs(solid_angle_between(none, half_solid_angle(u, from, to))) +
           fabs(solid_angle_between(none, half_solid_angle(v, from, to)));
}

// Area of the segment of grain K's disc beyond the opposite side: a large grain sticks
// out between two small ones. 0 where the disc covers an end of that side.
static double segment_beyond(const struct corner corner[3], int k)
{
    const struct corner *first = &corner[(k + 1) % 3], *second = &corner[(k + 2) % 3];
    if (is_wall(first) && is_wall(second)) return 0;
    const struct corner *begin = is_wall(first) ? second : first;
    const struct corner *end = is_wall(first) ? first : second;
    const struct vector side = towards(begin->at, end);
    const double length = is_wall(end) ? depth(end, begin->at) : norm(side);
    const struct vector along = is_wall(end) ? side : scale(1 / length, side);
    const struct vector to = subtract(begin->at, corner[k].at);
    const double foot = -dot(to, along), radius = corner[k].radius;
    const double away = norm(add(to, scale(foot, along)));
    if (!(away < radius)) return 0;
    const double half = sqrt((radius - away) * (radius + away));
    if (foot < half || foot > length - half) return 0;
    return radius * radius * acos(away / radius) - away * half;
}

// Sector, surface and volume of grain k in the facet and the throat.
static void measure_grain(const struct corner corner[3], int k, struct vector from,
                          struct vector to, bool partition, struct facet *facet)
{
    const struct vector at = corner[k].at;
    const struct vector u = towards(at, &corner[(k + 1) % 3]);
    const struct vector v = towards(at, &corner[(k + 2) % 3]);
    const double square = corner[k].radius * corner[k].radius;
    facet->sector[k] =
        0.5 * square * atan2(norm(cross(u, v)), dot(u, v)) - segment_beyond(corner, k);
    facet->surface[k] =
        square * solid_angle_at(u, v, subtract(from, at), subtract(to, at), partition);
    facet->volume -= corner[k].radius * facet->surface[k] / 3;
}

// Two grains and wall K: a trapezium from the line between them to the wall.
static void measure_at_wall(const struct corner corner[3], int k, struct vector step,
                            struct facet *facet)
{
    const struct corner *wall = &corner[k];
    const struct corner *i = &corner[(k + 1) % 3], *j = &corner[(k + 2) % 3];
    const struct vector across = cross(subtract(j->at, i->at), wall->normal);
    facet->area = scale(0.5 * (depth(wall, i->at) + depth(wall, j->at)), across);
    facet->surface[k] = 0.5 * dot(across, step);
}

// Grain K and two walls: a rectangle from the grain to the edge of the box.
static void measure_at_edge(const struct corner corner[3], int k, struct vector step,
                            struct facet *facet)
{
    const int first = (k + 1) % 3, second = (k + 2) % 3;
    const struct vector along = cross(corner[first].normal, corner[second].normal);
    const double to_first = depth(&corner[first], corner[k].at);
    const double to_second = depth(&corner[second], corner[k].at);
    facet->area = scale(to_first * to_second, along);
    facet->surface[first] = 0.5 * to_second * dot(along, step);
    facet->surface[second] = 0.5 * to_first * dot(along, step);
}

struct facet measure_facet(const struct corner corner[3], struct vector from,
                           struct vector to, bool partition)
{
    const struct vector step = subtract(to, from);
    struct facet facet = {.length = norm(step)};
    int walls = 0, wall = 0, grain = 0;
    for (int k = 0; k < 3; k++) {
        walls += is_wall(&corner[k]);
        if (is_wall(&corner[k]))
            wall = k;
        else
            grain = k;
    }
    if (walls == 0)
        facet.area = scale(0.5, cross(subtract(corner[1].at, corner[0].at),
                                      subtract(corner[2].at, corner[0].at)));
    else if (walls == 1)
        measure_at_wall(corner, wall, step, &facet);
    else
        measure_at_edge(corner, grain, step, &facet);
    facet.volume = dot(facet.area, step) / 3;
    for (int k = 0; k < 3; k++)
        if (!is_wall(&corner[k])) measure_grain(corner, k, from, to, partition, &facet);
    return facet;
}

// A circle of radius r that touches grain K and another corner: its middle m, relative
// to grain K, has m . across = off - r rate.
struct condition {
    struct vector across;
    double off, rate;
};

static struct condition touching(const struct corner *grain, const struct corner *other)
{
    if (is_wall(other))
        return (struct condition){other->normal, depth(other, grain->at), 1};
    const struct vector to = subtract(other->at, grain->at);
    const double r = grain->radius, s = other->radius;
    return (struct condition){to, 0.5 * (dot(to, to) + r * r - s * s), s - r};
}

// The smaller positive root of a x^2 + 2 b x + c, or 0.
static double smaller_root(double a, double b, double c)
{
    const double discriminant = b * b - a * c;
    if (!(discriminant >= 0)) return 0;
    const double q = -(b + copysign(sqrt(discriminant), b));
    const double first = q / a, second = q != 0 ? c / q : 0;
    const double low = fmin(first, second), high = fmax(first, second);
    if (isfinite(low) && low > 0) return low;
    return isfinite(high) && high > 0 ? high : 0;
}

double inscribed_radius(const struct corner corner[3])
{
    int k = 0;
    while (is_wall(&corner[k]))
        k++;
    const struct condition p = touching(&corner[k], &corner[(k + 1) % 3]);
    const struct condition q = touching(&corner[k], &corner[(k + 2) % 3]);
    const struct vector normal = cross(p.across, q.across);
    const double square = dot(normal, normal);
    if (!(square > 0)) return 0;
    // The middle, from grain k, is START + radius RATE.
    const struct vector to_p = scale(1 / square, cross(q.across, normal));
    const struct vector to_q = scale(1 / square, cross(normal, p.across));
    const struct vector start = add(scale(p.off, to_p), scale(q.off, to_q));
    const struct vector rate = add(scale(-p.rate, to_p), scale(-q.rate, to_q));
    const double r = corner[k].radius;
    return smaller_root(dot(rate, rate) - 1, dot(start, rate) - r,
                        dot(start, start) - r * r);
}
