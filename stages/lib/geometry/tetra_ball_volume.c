// SPDX-License-Identifier: GPL-3.0-or-later
// The volume outside a ball in a tetrahedron whose apex is the ball's centre.
//
// The base triangle is the signed sum of six right triangles in its plane: from the
// foot of the centre's perpendicular to the foot on an edge's line (h), and along that
// line (t). With d the height of the plane, each tetrahedron has the volume d h t / 6,
// less the ball's part:
//     d >= radius: radius^3 / 3 times the solid angle (ball_below),
//     d <  radius: the cone inside the disc of the plane, the ball beyond
//     (ball_through).
// Arc tangents of single quotients, so nothing cancels where a triangle is small.
#include "geometry/tetra_ball_volume.h"

static double square(double x)
{
    return x * x;
}

// Angle whose sine is sin(angle at the foot) times d over the distance of the edge's
// line: the integral of the cosine of the inclination of the edge's rays.
static double inclined(double d, double h, double t)
{
    return atan2(d * t, h * sqrt(d * d + h * h + t * t));
}

// The ball's share of the cone over a right triangle that it does not poke through.
// Less than a third of radius^3 times the angle: as one arc tangent, for no digits to
// cancel where the triangle is small.
static double ball_below(double radius, double d, double h, double t)
{
    const double aside2 = h * h + t * t, far = sqrt(d * d + aside2);
    return radius * square(radius) / 3 *
           atan2(t * h * aside2 / (far + d), h * h * far + d * t * t);
}

// Where it pokes through the plane, a distance D from its middle, in a disc: up to the
// disc's rim the whole cone, beyond it the cone below the disc and the ball beside.
static double ball_through(double radius, double d, double h, double t)
{
    const double disc2 = (radius - d) * (radius + d);
    const double rim = sqrt(fmax(0, disc2 - h * h)); // along the edge's line
    if (t <= rim) return d * h * t / 6;
    const double angle = atan2(t, h) - atan2(rim, h);
    return d * h * rim / 6 + d * (disc2 / 6 + square(radius) / 3) * angle -
           radius * square(radius) / 3 * (inclined(d, h, t) - inclined(d, h, rim));
}

// Outside the ball, in the tetrahedron over a right triangle: D the height, H from the
// foot to the edge's line, T along it.
static double outside_over(double radius, double d, double h, double t)
{
    const double along = fabs(t);
    const double ball = d < radius ? ball_through(radius, d, h, along)
                                   : ball_below(radius, d, h, along);
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

double tetrahedron_outside_ball(double radius, struct vector a, struct vector b,
                                struct vector c)
{
    const struct vector area = cross(subtract(b, a), subtract(c, a));
    const double size = norm(area);
    if (!(size > 0)) return 0;
    const struct vector normal = scale(1 / size, area);
    const double d = dot(normal, a);
    const struct vector foot = scale(d, normal);
    const struct vector p = subtract(a, foot), q = subtract(b, foot),
                        r = subtract(c, foot);
    const double sum = outside_over_edge(radius, fabs(d), normal, p, q) +
                       outside_over_edge(radius, fabs(d), normal, q, r) +
                       outside_over_edge(radius, fabs(d), normal, r, p);
    return d < 0 ? -sum : sum;
}
