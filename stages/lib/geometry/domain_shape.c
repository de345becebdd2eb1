// SPDX-License-Identifier: GPL-3.0-or-later
// Convex domains (box, cylinder, disc, sphere): inside or not, the span of a line, the
// nearest surface point and the outward normal. With from and along the parts across
// the axis, |from + t along| = radius is
//     a t^2 + 2 b t + c = 0,  a = along.along,  b = from.along,
//     c = (|from| - radius)(|from| + radius),
//     far = -(b + sign(b) sqrt(b^2 - a c)),  t = far / a and c / far.
// The usual formula would lose the smaller root.
#include "geometry/domain_shape.h"

bool body_is_round(const struct body *body, int axis)
{
    switch ((enum body_shape)body->shape) {
    case BODY_CYLINDER:
        return axis != 2;
    case BODY_DISC:
        return axis != 1;
    case BODY_SPHERE:
        return true;
    default:
        return false;
    }
}

static struct vector centre_of(const struct body *body)
{
    return midpoint(body->lower, body->upper);
}

static double radius_of(const struct body *body)
{
    return 0.5 * (body->upper.x - body->lower.x);
}

struct vector body_round_part(const struct body *body, struct vector x)
{
    for (int axis = 0; axis < 3; axis++)
        if (!body_is_round(body, axis)) set_component(&x, axis, 0);
    return x;
}

bool body_holds(const struct body *body, struct vector x)
{
    for (int axis = 0; axis < 3; axis++) {
        const double at = component(x, axis);
        if (at < component(body->lower, axis) || at > component(body->upper, axis))
            return false;
    }
    return body->shape == BODY_BOX ||
           norm(body_round_part(body, subtract(x, centre_of(body)))) <= radius_of(body);
}

// |from + t along| = radius, without subtracting near-equal numbers.
static bool round_span(double radius, struct vector from, struct vector along,
                       double span[2])
{
    const double a = dot(along, along), b = dot(from, along);
    const double c = (norm(from) - radius) * (norm(from) + radius);
    if (a == 0) return c <= 0;
    const double discriminant = b * b - a * c;
    if (discriminant < 0) return false;
    const double far = -(b + copysign(sqrt(discriminant), b));
    const double one = far / a, other = far == 0 ? one : c / far;
    span[0] = fmax(span[0], fmin(one, other));
    span[1] = fmin(span[1], fmax(one, other));
    return span[0] < span[1];
}

static bool flat_span(double lower, double upper, double from, double along,
                      double span[2])
{
    if (along == 0) return from >= lower && from <= upper;
    const double one = (lower - from) / along, other = (upper - from) / along;
    span[0] = fmax(span[0], fmin(one, other));
    span[1] = fmin(span[1], fmax(one, other));
    return span[0] < span[1];
}

bool body_span(const struct body *body, struct vector from, struct vector to,
               double span[2])
{
    const struct vector along = subtract(to, from);
    span[0] = -HUGE_VAL;
    span[1] = HUGE_VAL;
    for (int axis = 0; axis < 3; axis++)
        if (!body_is_round(body, axis) &&
            !flat_span(component(body->lower, axis), component(body->upper, axis),
                       component(from, axis), component(along, axis), span))
            return false;
    return body->shape == BODY_BOX ||
           round_span(radius_of(body),
                      body_round_part(body, subtract(from, centre_of(body))),
                      body_round_part(body, along), span);
}

// The nearest side, for a point in the box; else the nearest point of all.
static struct vector nearest_on_box(const struct body *box, struct vector x)
{
    int nearest = 0;
    double least = HUGE_VAL;
    for (int side = 0; side < 6; side++) {
        const int axis = side / 2;
        const struct vector *corner = side % 2 ? &box->upper : &box->lower;
        const double off = fabs(component(x, axis) - component(*corner, axis));
        if (off < least) {
            least = off;
            nearest = side;
        }
    }
    const bool within = body_holds(box, x);
    for (int axis = 0; axis < 3 && !within; axis++)
        set_component(&x, axis,
                      fmin(fmax(component(x, axis), component(box->lower, axis)),
                           component(box->upper, axis)));
    if (within)
        set_component(&x, nearest / 2,
                      component(nearest % 2 ? box->upper : box->lower, nearest / 2));
    return x;
}

struct vector body_outward(const struct body *body, struct vector x)
{
    if (body->shape == BODY_BOX) return (struct vector){0, 0, 1};
    const struct vector out = body_round_part(body, subtract(x, centre_of(body)));
    const double away = norm(out);
    return away > 0 ? scale(1 / away, out) : (struct vector){1, 0, 0}; // any will do
}

struct vector body_nearest_round(const struct body *body, struct vector x)
{
    if (body->shape == BODY_BOX) return nearest_on_box(body, x);
    const struct vector out = body_round_part(body, subtract(x, centre_of(body)));
    const struct vector middle = subtract(x, out); // on the axis, or the centre
    return add(middle, scale(radius_of(body), body_outward(body, x)));
}

struct vector body_nearest(const struct body *body, struct vector x)
{
    const struct vector round = body_nearest_round(body, x);
    if (body->shape == BODY_BOX || body->shape == BODY_SPHERE) return round;
    const int axis = body->shape == BODY_CYLINDER ? 2 : 1;
    const double at = component(x, axis), low = component(body->lower, axis),
                 high = component(body->upper, axis);
    const double end = at - low < high - at ? low : high;
    const double out = norm(body_round_part(body, subtract(x, centre_of(body))));
    const bool beyond = at < low || at > high;
    if (out > radius_of(body) || (!beyond && radius_of(body) - out <= fabs(end - at)))
        x = round;
    else
        set_component(&x, axis, end);
    if (beyond) set_component(&x, axis, end);
    return x;
}
