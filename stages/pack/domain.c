// SPDX-License-Identifier: GPL-3.0-or-later
// Geometry of the domain: volume, containment, and uniform random points. A cut-out is
// symmetric about its centre, so the distance to it is that to its nearest periodic
// image. Uniform points in a disc have the radius sqrt(u) R, in a ball cbrt(u) R with a
// uniform height (Archimedes); points in a cut-out are drawn again.
//
// Volumes are exact since a cut-out lies wholly inside (make_domain.c):
//     box x y z,  cylinder and ring pi (R^2 - inner^2) z,  sphere (4/3) pi R^3,
// less the same of what is cut out.
//
// Containment is to domain_rounding, so that a grain that was put in touch with a wall
// counts as inside; random points keep their whole radius from walls and cut-out.
// Periodic axes have no wall, but a cut-out and a round wall do not repeat with them.
#include "domain.h"

#include <float.h>

// Eight units in the last place of the largest coordinate.
double domain_rounding(const struct domain *domain)
{
    double extent = 0;
    for (int axis = 0; axis < 3; axis++)
        extent = fmax(extent, fmax(fabs(component(domain->lower, axis)),
                                   fabs(component(domain->upper, axis))));
    return 8 * DBL_EPSILON * extent;
}

// About the lower corner, as dem_rescale does.
void domain_stretch(struct domain *box, double factor)
{
    for (int axis = 0; axis < 3; axis++) {
        if (box->dimensions == 2 && axis == 1) continue;
        const double low = component(box->lower, axis);
        set_component(&box->upper, axis,
                      low + factor * (component(box->upper, axis) - low));
    }
    box->centre = midpoint(box->lower, box->upper);
}

// In m3, with the thickness of the layer in two dimensions.
double domain_volume(const struct domain *domain)
{
    const struct vector edge = subtract(domain->upper, domain->lower);
    const struct vector cut = subtract(domain->cut_upper, domain->cut_lower);
    const bool flat = domain->dimensions == 2;
    const double disc = M_PI * domain->radius * domain->radius;
    const double hole = M_PI * domain->cut_radius * domain->cut_radius;
    const double inner = M_PI * domain->inner_radius * domain->inner_radius;
    double volume = 0;
    switch (domain->shape) {
    case DOMAIN_BOX:
        volume = box_volume(edge);
        break;
    case DOMAIN_CYLINDER:
    case DOMAIN_RING:
        volume = (disc - inner) * edge.z;
        break;
    case DOMAIN_SPHERE:
        volume = disc * (flat ? edge.y : 4 * domain->radius / 3);
        break;
    }
    switch (domain->cut) {
    case CUT_NONE:
        return volume;
    case CUT_BOX:
        return volume - box_volume(cut);
    case CUT_CYLINDER:
        return volume - hole * cut.z;
    case CUT_SPHERE:
        return volume - hole * (flat ? cut.y : 4 * domain->cut_radius / 3);
    }
    return volume;
}

// A ring is two cylinders: grains within one and around the other.
int domain_bodies(const struct domain *domain, struct body body[MOST_BODIES])
{
    const bool flat = domain->dimensions == 2;
    const uint8_t ball = flat ? BODY_DISC : BODY_SPHERE;
    const struct vector lower = domain->lower, upper = domain->upper;
    const struct vector inner = {domain->inner_radius, domain->inner_radius, 0};
    struct vector low = subtract(domain->centre, inner),
                  high = add(low, scale(2, inner));
    int n = 0;
    low.z = lower.z;
    high.z = upper.z;
    if (domain->shape == DOMAIN_CYLINDER || domain->shape == DOMAIN_RING)
        body[n++] = (struct body){BODY_CYLINDER, 1, lower, upper};
    if (domain->shape == DOMAIN_RING)
        body[n++] = (struct body){BODY_CYLINDER, 0, low, high};
    if (domain->shape == DOMAIN_SPHERE)
        body[n++] = (struct body){ball, 1, lower, upper};
    const uint8_t shape[] = {
        [CUT_BOX] = BODY_BOX, [CUT_CYLINDER] = BODY_CYLINDER, [CUT_SPHERE] = ball};
    if (domain->cut != CUT_NONE)
        body[n++] =
            (struct body){shape[domain->cut], 0, domain->cut_lower, domain->cut_upper};
    return n;
}

// Whether HOLE, which grains lie around, and the cylinder DOMAIN have one axis and the
// same ends: together they are a ring.
static bool makes_ring(const struct domain *domain, const struct body *hole)
{
    const double slack = domain_rounding(domain);
    const struct vector apart =
        subtract(midpoint(hole->lower, hole->upper), domain->centre);
    return domain->shape == DOMAIN_CYLINDER && hole->shape == BODY_CYLINDER &&
           across(apart.x, apart.y) <= slack &&
           fabs(hole->lower.z - domain->lower.z) <= slack &&
           fabs(hole->upper.z - domain->upper.z) <= slack;
}

static bool cut_body(struct domain *domain, const struct body *hole)
{
    const bool first = domain->cut == CUT_NONE;
    domain->cut = hole->shape == BODY_BOX        ? CUT_BOX
                  : hole->shape == BODY_CYLINDER ? CUT_CYLINDER
                                                 : CUT_SPHERE;
    domain->cut_lower = hole->lower;
    domain->cut_upper = hole->upper;
    domain->cut_centre = midpoint(hole->lower, hole->upper);
    domain->cut_radius = 0.5 * (hole->upper.x - hole->lower.x);
    return first;
}

// The outer wall. What the box has beyond it holds nothing: the box ends with BODY.
static bool shape_by(struct domain *domain, const struct body *body)
{
    if (domain->shape != DOMAIN_BOX || body->shape == BODY_BOX) return false;
    const double slack = domain_rounding(domain);
    for (int axis = 0; axis < 3; axis++)
        if (component(body->lower, axis) < component(domain->lower, axis) - slack ||
            component(body->upper, axis) > component(domain->upper, axis) + slack)
            return false;
    domain->shape = body->shape == BODY_CYLINDER ? DOMAIN_CYLINDER : DOMAIN_SPHERE;
    domain->lower = body->lower;
    domain->upper = body->upper;
    domain->centre = midpoint(body->lower, body->upper);
    domain->radius = 0.5 * (body->upper.x - body->lower.x);
    return true;
}

bool domain_of(const struct packing *packing, int dimensions, struct domain *domain)
{
    *domain = (struct domain){.dimensions = dimensions,
                              .lower = packing->lower,
                              .upper = packing->upper,
                              .centre = midpoint(packing->lower, packing->upper)};
    for (int axis = 0; axis < 3; axis++)
        domain->periodic[axis] = packing->periodic[axis];
    bool known = true;
    for (int k = 0; k < packing->n_body; k++) {
        const struct body *body = &packing->body[k];
        if (body->shape == BODY_DISC) domain->dimensions = 2;
        if (body->within) {
            known = shape_by(domain, body) && known;
        } else if (makes_ring(domain, body)) {
            domain->shape = DOMAIN_RING;
            domain->inner_radius = 0.5 * (body->upper.x - body->lower.x);
        } else {
            known = cut_body(domain, body) && known;
        }
    }
    return known;
}

struct vector domain_wrap(const struct domain *domain, struct vector point)
{
    for (int axis = 0; axis < 3; axis++) {
        if (!domain->periodic[axis]) continue;
        const double low = component(domain->lower, axis);
        const double edge = component(domain->upper, axis) - low;
        const double at = component(point, axis);
        const double inside = at - edge * floor((at - low) / edge);
        // rounding may land on the upper side, which is the lower one
        set_component(&point, axis, inside < low + edge ? fmax(inside, low) : low);
    }
    return point;
}

struct vector nearest_apart(const struct domain *domain, struct vector from,
                            struct vector to)
{
    struct vector apart = subtract(to, from);
    for (int axis = 0; axis < 3; axis++) {
        if (!domain->periodic[axis]) continue;
        const double edge =
            component(domain->upper, axis) - component(domain->lower, axis);
        const double along = component(apart, axis);
        set_component(&apart, axis, along - edge * round(along / edge));
    }
    return apart;
}

// From the centre of the cut-out to the nearest image of POINT.
static struct vector from_cut(const struct domain *domain, struct vector point)
{
    struct vector apart = nearest_apart(domain, domain->cut_centre, point);
    if (domain->dimensions == 2) apart.y = 0;
    return apart;
}

// Distance from a grain's centre to what is cut out; 0 within it.
static double distance_to_cut(const struct domain *domain, struct vector point)
{
    if (domain->cut == CUT_NONE) return HUGE_VAL;
    const struct vector apart = from_cut(domain, point);
    if (domain->cut == CUT_SPHERE) return fmax(norm(apart) - domain->cut_radius, 0);
    const struct vector edge = subtract(domain->cut_upper, domain->cut_lower);
    const double up = fmax(fabs(apart.z) - edge.z / 2, 0);
    if (domain->cut == CUT_CYLINDER)
        return across(fmax(across(apart.x, apart.y) - domain->cut_radius, 0), up);
    return norm((struct vector){fmax(fabs(apart.x) - edge.x / 2, 0),
                                fmax(fabs(apart.y) - edge.y / 2, 0), up});
}

static bool shape_holds(const struct domain *domain, struct vector centre,
                        double radius, double slack)
{
    for (int axis = 0; axis < 3; axis++) {
        if (domain->periodic[axis]) continue;
        const double at = component(centre, axis);
        if (at - radius < component(domain->lower, axis) - slack) return false;
        if (at + radius > component(domain->upper, axis) + slack) return false;
    }
    if (domain->shape == DOMAIN_BOX) return true;
    struct vector apart = subtract(centre, domain->centre);
    if (domain->dimensions == 2) apart.y = 0;
    if (domain->shape == DOMAIN_SPHERE)
        return norm(apart) + radius <= domain->radius + slack;
    const double out = across(apart.x, apart.y);
    if (domain->shape == DOMAIN_RING && out - radius < domain->inner_radius - slack)
        return false;
    return out + radius <= domain->radius + slack;
}

bool domain_holds(const struct domain *domain, struct vector centre, double radius)
{
    const double slack = domain_rounding(domain);
    return shape_holds(domain, centre, radius, slack) &&
           distance_to_cut(domain, centre) >= radius - slack;
}

// ---- random points ------------------------------------------------------------------

static double between(double low, double high, gsl_rng *random)
{
    return low + (high - low) * gsl_rng_uniform(random);
}

// Uniform along a periodic axis; else at least RADIUS from the walls.
static double random_along(const struct domain *domain, int axis, double radius,
                           gsl_rng *random)
{
    const double low = component(domain->lower, axis);
    const double high = component(domain->upper, axis);
    if (domain->dimensions == 2 && axis == 1) return component(domain->centre, 1);
    if (domain->periodic[axis]) return between(low, high, random);
    return between(low + radius, fmax(high - radius, low + radius), random);
}

static struct vector random_in_disc(double inner, double outer, gsl_rng *random)
{
    const double out = sqrt(between(inner * inner, outer * outer, random));
    const double angle = between(0, 2 * M_PI, random);
    return (struct vector){out * cos(angle), out * sin(angle), 0};
}

static struct vector random_in_shape(const struct domain *domain, double radius,
                                     gsl_rng *random)
{
    const double outer = fmax(domain->radius - radius, 0);
    struct vector point;
    switch (domain->shape) {
    case DOMAIN_BOX:
        point.x = random_along(domain, 0, radius, random);
        point.y = random_along(domain, 1, radius, random);
        point.z = random_along(domain, 2, radius, random);
        return point;
    case DOMAIN_CYLINDER:
    case DOMAIN_RING:
        point = random_in_disc(domain->shape == DOMAIN_RING
                                   ? fmin(domain->inner_radius + radius, outer)
                                   : 0,
                               outer, random);
        point = add(domain->centre, point);
        point.z = random_along(domain, 2, radius, random);
        return point;
    case DOMAIN_SPHERE:
        break;
    }
    if (domain->dimensions == 2) {
        const struct vector in = random_in_disc(0, outer, random);
        return add(domain->centre, (struct vector){in.x, 0, in.y});
    }
    // Archimedes: height is evenly distributed on a sphere
    const double out = outer * cbrt(gsl_rng_uniform(random));
    const double height = between(-1, 1, random), angle = between(0, 2 * M_PI, random);
    const double side = sqrt(1 - height * height);
    return add(domain->centre, scale(out, (struct vector){side * cos(angle),
                                                          side * sin(angle), height}));
}

bool domain_random_point(const struct domain *domain, double radius, gsl_rng *random,
                         struct vector *point)
{
    enum { MAX_TRIES = 100000 }; // of missing what is cut out
    for (int k = 0; k < MAX_TRIES; k++) {
        *point = domain_wrap(domain, random_in_shape(domain, radius, random));
        if (distance_to_cut(domain, *point) >= radius) return true;
    }
    return false;
}

enum status domain_check_filling(const struct domain *domain, const double *radius,
                                 int n, struct reason *reason)
{
    const bool flat = domain->dimensions == 2;
    const double room = domain_volume(domain);
    const double thick = domain->upper.y - domain->lower.y;
    double share = 0;
    for (int i = 0; i < n; i++)
        share += flat ? M_PI * radius[i] * radius[i] * thick / room
                      : 4 * M_PI / 3 * radius[i] * radius[i] * radius[i] / room;
    if (share <= 1) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "pack.count: must be fewer: %d grains would fill %.3g of the domain, "
                  "at most 1 can be",
                  n, share);
}
