// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes of spheres and of lenses (what two spheres share) inside an axis-parallel
// box.
//
// The unit ball in a box is the signed sum over the eight corners of `corner(a, b, c)`,
// the volume of x > a, y > b, z > c. By the theorem of Gauss that is
//     (spherical area - a face_a - b face_b - c face_c) / 3,
// with the area by Gauss and Bonnet; negative a, b, c by reflection. A lens is two
// caps; below a plane each is a `wedge` between two planes, by the same theorem. In a
// box that cuts a lens along more than one axis the shares are multiplied, an
// approximation.
#include "geometry/sphere_box_volume.h"

static double square(double x)
{
    return x * x;
}

// ---- spheres ------------------------------------------------------------------------

// One face of the corner below, on the plane x = a: the part y > b, z > c of a disc.
struct face {
    double angle; // of the arc that ends it, about the middle of the disc
    double area;
};

static struct face corner_face(double a, double b, double c)
{
    const double disc = 1 - a * a;
    const double along_b = sqrt(disc - b * b), along_c = sqrt(disc - c * c);
    const double angle = atan2(along_c, c) - atan2(b, along_b);
    return (struct face){angle,
                         0.5 * (disc * angle - b * (along_b - c) - c * (along_c - b))};
}

// Angle between the arcs x = a and y = b of the unit sphere where they meet.
static double corner_angle(double a, double b)
{
    return acos(a * b / sqrt((1 - a * a) * (1 - b * b)));
}

// Volume of x > a, y > b, z > c in the unit ball. For a, b, c >= 0 by the theorem of
// Gauss: a third of the spherical area (Gauss-Bonnet) less the faces times their
// distances. The rest by reflection.
static double corner(double a, double b, double c)
{
    if (a < 0) return 2 * corner(0, b, c) - corner(-a, b, c);
    if (b < 0) return 2 * corner(a, 0, c) - corner(a, -b, c);
    if (c < 0) return 2 * corner(a, b, 0) - corner(a, b, -c);
    if (a * a + b * b + c * c >= 1) return 0;
    const struct face x = corner_face(a, b, c), y = corner_face(b, c, a),
                      z = corner_face(c, a, b);
    const double sphere = corner_angle(a, b) + corner_angle(b, c) + corner_angle(c, a) -
                          M_PI - a * x.angle - b * y.angle - c * z.angle;
    return (sphere - a * x.area - b * y.area - c * z.area) / 3;
}

static double clamped(double x)
{
    return fmax(-1, fmin(x, 1));
}

static double unit_ball_in_box(const double low[3], const double high[3])
{
    double volume = 0;
    for (int k = 0; k < 8; k++) {
        const double *at[3];
        for (int axis = 0; axis < 3; axis++)
            at[axis] = k >> axis & 1 ? &high[axis] : &low[axis];
        const double sign = (k ^ k >> 1 ^ k >> 2) & 1 ? -1 : 1;
        volume += sign * corner(*at[0], *at[1], *at[2]);
    }
    return volume;
}

double sphere_in_box(double radius, struct vector lower, struct vector upper)
{
    double low[3], high[3];
    int cuts = 0, cut = 2;
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = clamped(component(lower, axis) / radius);
        high[axis] = clamped(component(upper, axis) / radius);
        if (low[axis] >= high[axis]) return 0;
        if (low[axis] == -1 && high[axis] == 1) continue;
        cuts++;
        cut = axis;
    }
    const double a = low[cut], b = high[cut]; // -1 and 1 where nothing cuts
    const double share = cuts > 1 ? unit_ball_in_box(low, high)
                                  : M_PI * (b - a) * (1 - (a * a + a * b + b * b) / 3);
    return share * radius * radius * radius;
}

// ---- lenses -------------------------------------------------------------------------

double lens_volume(double first, double second, double distance)
{
    const double overlap = first + second - distance;
    if (overlap <= 0) return 0;
    if (distance <= fabs(first - second))
        return 4 * M_PI / 3 * pow(fmin(first, second), 3);
    return M_PI * overlap * overlap *
           (distance * (distance + 2 * (first + second)) - 3 * square(first - second)) /
           (12 * distance);
}

// From the first centre to the plane in which the spheres meet.
static double meeting_plane(const struct lens *lens)
{
    const double a = lens->first, b = lens->second, d = lens->distance;
    return (d + (a - b) / d * (a + b)) / 2;
}

// An end of the lens along an axis is where one sphere ends inside the other, or else
// on the circle in which they meet.
static void find_bounds(struct lens *lens)
{
    const double a = lens->first, b = lens->second, d = lens->distance;
    const double plane = meeting_plane(lens);
    const double rim = sqrt((a + b - d) * (a + b + d) * (d + a - b) * (d - a + b)) / 2;
    for (int axis = 0; axis < 3; axis++) {
        const double along = component(lens->apart, axis) / d;
        const double aside2 = fmax(0, 1 - along * along) * d * d, z = along * d;
        const double reach = rim * sqrt(aside2) / d / d;
        const double top = aside2 + (a - z) * (a - z) <= b * b ? a
                           : aside2 + (z + b) * (z + b) <= a * a
                               ? z + b
                               : plane * along + reach;
        const double low = aside2 + (a + z) * (a + z) <= b * b ? -a
                           : aside2 + (z - b) * (z - b) <= a * a
                               ? z - b
                               : plane * along - reach;
        set_component(&lens->lower, axis, low);
        set_component(&lens->upper, axis, top);
    }
}

struct lens lens_between(double first, double second, struct vector apart)
{
    struct lens lens = {
        .first = first, .second = second, .apart = apart, .distance = norm(apart)};
    lens.volume = lens_volume(first, second, lens.distance);
    if (lens.volume <= 0) return lens;
    if (lens.distance > fabs(first - second)) {
        find_bounds(&lens);
        return lens;
    }
    const double r = fmin(first, second); // one inside the other
    const struct vector half = {r, r, r};
    lens.inside = true;
    lens.middle = first <= second ? (struct vector){0} : apart;
    lens.lower = subtract(lens.middle, half);
    lens.upper = add(lens.middle, half);
    return lens;
}

// Cap of the unit ball beyond a plane at distance D from its middle.
static double cap(double d)
{
    return M_PI / 3 * (1 - d) * (1 - d) * (2 + d);
}

// What two planes leave of the unit ball: n.x > d and m.x > e, with COSINE = n.m.
// As for the corner above; the plane n.x = d keeps a segment of its disc, beyond a line
// at t from the middle of the disc.
static double wedge(double d, double e, double cosine)
{
    const double sine = sqrt(fmax(0, 1 - cosine * cosine));
    const double disc_d = 1 - d * d, disc_e = 1 - e * e;
    const double t_d = e - d * cosine, t_e = d - e * cosine; // times sine
    const double most_d = sqrt(disc_d) * sine, most_e = sqrt(disc_e) * sine;
    const bool opposite = t_e == 0 && cosine < 0;
    if (t_d >= most_d) return t_e <= -most_e && !opposite ? cap(e) : 0;
    if (t_d <= -most_d) return t_e <= -most_e ? cap(d) - cap(-e) : cap(d);
    if (fabs(t_e) >= most_e) return t_e < 0 ? cap(e) : 0; // by rounding only
    const double x_d = t_d / most_d, x_e = t_e / most_e;
    const double half_d = acos(x_d), half_e = acos(x_e); // of the arcs that are left
    const double between = (d * e - cosine) / sqrt(disc_d * disc_e);
    const double sphere =
        2 * (acos(fmax(-1, fmin(between, 1))) - d * half_d - e * half_e);
    const double face_d = disc_d * (half_d - x_d * sqrt(1 - x_d * x_d));
    const double face_e = disc_e * (half_e - x_e * sqrt(1 - x_e * x_e));
    return (sphere - d * face_d - e * face_e) / 3;
}

// The part of a lens below HEIGHT along an axis: two caps of spheres, each cut by it.
static double lens_below(const struct lens *lens, int axis, double height)
{
    const double a = lens->first, b = lens->second;
    const double z = component(lens->apart, axis), cosine = z / lens->distance;
    const double plane = meeting_plane(lens);
    return a * a * a * wedge(clamped(plane / a), clamped(-height / a), -cosine) +
           b * b * b *
               wedge(clamped((lens->distance - plane) / b), clamped((z - height) / b),
                     cosine);
}

double lens_in_box(const struct lens *lens, struct vector lower, struct vector upper)
{
    if (lens->inside)
        return sphere_in_box(fmin(lens->first, lens->second),
                             subtract(lower, lens->middle),
                             subtract(upper, lens->middle));
    double part = lens->volume;
    for (int axis = 0; axis < 3 && part > 0; axis++) {
        const double low = component(lower, axis), high = component(upper, axis);
        const double bottom = component(lens->lower, axis);
        const double top = component(lens->upper, axis);
        if (low >= top || high <= bottom) return 0;
        if (low <= bottom && high >= top) continue;
        const double kept = (high < top ? lens_below(lens, axis, high) : lens->volume) -
                            (low > bottom ? lens_below(lens, axis, low) : 0);
        part *= fmax(0, fmin(kept / lens->volume, 1)); // rounding, where it is thin
    }
    return part;
}
