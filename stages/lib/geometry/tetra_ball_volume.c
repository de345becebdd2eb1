// SPDX-License-Identifier: GPL-3.0-or-later
// The volume outside a ball in a tetrahedron whose apex is the ball's centre.
//
// Where the ball does not poke through the base, it has radius^3 / 3 times the solid
// angle of the tetrahedron. Where it does, in a disc of the base's plane, the triangle
// is the signed sum of six right triangles in that plane: from the foot of the centre's
// perpendicular to the foot on an edge's line (h), and along that line (t). With d the
// height of the plane, the tetrahedron over each has the volume d h t / 6, less the
// cone inside the disc and the ball beyond (ball_through).
// Angles are arc tangents of single quotients, differences of angles too, so nothing
// cancels where a triangle is small or ends near the disc.
#include "geometry/tetra_ball_volume.h"

#include "geometry/solid_angle.h"

#include <stdbool.h>

static double square(double x)
{
    return x * x;
}

static double cube(double x)
{
    return x * x * x;
}

// The integral of the cosine of the inclination of the rays to an edge's line, from
// FROM to TO along it: the difference of the angles
//     atan2(d t, h sqrt(d^2 + h^2 + t^2)),
// whose sines are sin(angle at the foot) times d over the distance of the line.
static double inclined(double d, double h, double from, double to)
{
    const double line2 = d * d + h * h;
    const double near = sqrt(line2 + from * from), far = sqrt(line2 + to * to);
    return atan2(d * h * line2 * (to - from) * (to + from) / (to * near + from * far),
                 h * h * near * far + d * d * from * to);
}

// The ball's share of the cone over a right triangle, whose plane is a distance D from
// its middle: up to the disc's rim the whole cone, beyond it the cone below the disc
// and the ball beside.
static double ball_through(double radius, double d, double h, double t)
{
    const double disc2 = (radius - d) * (radius + d);
    const double rim = sqrt(fmax(0, disc2 - h * h)); // along the edge's line
    if (t <= rim) return d * h * t / 6;
    const double angle = atan2(h * (t - rim), h * h + t * rim);
    return d * h * rim / 6 + d * (disc2 / 6 + square(radius) / 3) * angle -
           cube(radius) / 3 * inclined(d, h, rim, t);
}

// Outside the ball, in the tetrahedron over a right triangle: D the height, H from the
// foot to the edge's line, T along it.
static double outside_over(double radius, double d, double h, double t)
{
    const double along = fabs(t), ball = ball_through(radius, d, h, along);
    return copysign(d * h * along / 6 - ball, t);
}

// The two right triangles of the edge from P to Q, both seen from the foot.
static double outside_over_edge(double radius, double d, struct vector normal,
                                struct vector p, struct vector q)
{
    const struct vector edge = subtract(q, p);
    const double length = norm(edge);
    if (!(length > 0)) return 0;
    const double h = dot(normal, cross(p, q)) / length;
    const double from = dot(p, edge) / length, to = dot(q, edge) / length;
    const double sum =
        outside_over(radius, d, fabs(h), to) - outside_over(radius, d, fabs(h), from);
    return h < 0 ? -sum : sum;
}

// Over the triangle P Q R, seen from the foot, in a plane that the ball cuts.
static double outside_beside_disc(double radius, double d, struct vector normal,
                                  struct vector p, struct vector q, struct vector r)
{
    return outside_over_edge(radius, d, normal, p, q) +
           outside_over_edge(radius, d, normal, q, r) +
           outside_over_edge(radius, d, normal, r, p);
}

// Whether the disc of radius^2 DISC2 around the foot lies beyond the line through P and
// Q, seen from the triangle.
static bool is_beyond(double disc2, struct vector normal, struct vector p,
                      struct vector q)
{
    const double twice =
        dot(normal, cross(p, q)); // foot, P, Q; below 0 beyond the line
    const struct vector edge = subtract(q, p);
    return twice < 0 && twice * twice >= disc2 * dot(edge, edge);
}

double tetrahedron_outside_ball(double radius, struct vector a, struct vector b,
                                struct vector c)
{
    const struct vector area = cross(subtract(b, a), subtract(c, a));
    const double size = norm(area);
    if (!(size > 0)) return 0;
    const struct vector normal = scale(1 / size, area);
    const double d = dot(normal, a), disc2 = (radius - d) * (radius + d);
    const struct vector foot = scale(d, normal);
    const struct vector p = subtract(a, foot), q = subtract(b, foot),
                        r = subtract(c, foot);
    if (!(disc2 > 0) || is_beyond(disc2, normal, p, q) ||
        is_beyond(disc2, normal, q, r) || is_beyond(disc2, normal, r, p)) {
        const double six = dot(area, a), real = half_solid_angle(a, b, c).real;
        return six / 6 - cube(radius) / 3 * 2 * atan2(six, real);
    }
    const double sum = outside_beside_disc(radius, fabs(d), normal, p, q, r);
    return d < 0 ? -sum : sum;
}
