// SPDX-License-Identifier: GPL-3.0-or-later
// The domain from the user's parameters, with all checks: it must be complete, have
// room for the largest grain, and contain its cut-out entirely (else its volume is not
// known).
//
// Where cylinders, rings and spheres contain a cut-out is decided by its farthest and
// nearest points from the axis, or from the centre: for a box those of its corners and
// faces, which is exact as all domains are convex but for the hole of a ring.
//
// A domain is given by the box around it, even if it is round: lower = centre - half,
// upper = centre + half, with half the radius along round axes and half the height
// along z. In two dimensions (x and z) the box is one largest diameter thick along y.
#include "domain.h"

// ---- the shape ----------------------------------------------------------------------

// The lower corner is the origin unless given. Comparisons are written so that NAN
// fails.
static enum status make_box(const struct domain_parameters *parameters,
                            struct domain *domain, double largest,
                            struct reason *reason)
{
    for (int axis = 0; axis < 3; axis++) {
        const bool flat = domain->dimensions == 2 && axis == 1;
        double low = parameters->lower[axis], high = parameters->upper[axis];
        if (isnan(low)) low = 0;
        if (flat) high = low + 2 * largest;
        if (isnan(high))
            return refuse(reason, STATUS_BAD_DATA,
                          "pack.upper: must be given: the box to fill");
        if (!(low < high))
            return refuse(
                reason, STATUS_BAD_DATA,
                "pack.upper: must be above pack.lower = %g m along %c, got %g", low,
                "xyz"[axis], high);
        set_component(&domain->lower, axis, low);
        set_component(&domain->upper, axis, high);
    }
    return STATUS_OK;
}

// A box that repeats and a round wall across it would contradict each other.
static enum status check_round(const struct domain_parameters *parameters,
                               const struct domain *domain, struct reason *reason)
{
    const bool sphere = domain->shape == DOMAIN_SPHERE;
    if (domain->dimensions == 2 && !sphere)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.domain.shape: must be box or sphere (a disc) in two "
                      "dimensions");
    if (isnan(parameters->radius))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.domain.radius: must be given, for this shape");
    if (!sphere && isnan(parameters->height))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.domain.height: must be given, for this shape");
    if (domain->shape == DOMAIN_RING &&
        !(parameters->inner_radius < parameters->radius))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.domain.inner_radius: must be given and below "
                      "pack.domain.radius = %g m, for a ring",
                      parameters->radius);
    const bool *periodic = parameters->periodic;
    if (periodic[0] || periodic[1] || (periodic[2] && sphere))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.periodic: must be false where the wall is round");
    return STATUS_OK;
}

// The centre, unless given, is where the box begins at the origin.
static enum status make_round(const struct domain_parameters *parameters,
                              struct domain *domain, double largest,
                              struct reason *reason)
{
    const enum status status = check_round(parameters, domain, reason);
    if (status) return status;
    const double radius = parameters->radius;
    struct vector half = {radius, radius, radius};
    if (domain->shape != DOMAIN_SPHERE) half.z = parameters->height / 2;
    if (domain->dimensions == 2) half.y = largest;
    domain->centre =
        isnan(parameters->centre[0]) ? half : as_vector(parameters->centre);
    domain->radius = radius;
    domain->inner_radius = domain->shape == DOMAIN_RING ? parameters->inner_radius : 0;
    domain->lower = subtract(domain->centre, half);
    domain->upper = add(domain->centre, half);
    return STATUS_OK;
}

// Refuses a shape too narrow for the largest grain. Slack is what rounding of
// coordinates may take, so that a box exactly as wide as a grain passes.
static enum status check_room(const struct domain *domain, double largest,
                              struct reason *reason)
{
    const bool box = domain->shape == DOMAIN_BOX;
    const struct vector edge = subtract(domain->upper, domain->lower);
    const double slack = domain_rounding(domain);
    for (int axis = 0; axis < 3; axis++)
        if (component(edge, axis) + slack < 2 * largest)
            return refuse(
                reason, STATUS_BAD_DATA,
                "%s: must leave room for a grain of radius %g m, is %g m wide "
                "along %c",
                box                                           ? "pack.upper"
                : axis == 2 && domain->shape != DOMAIN_SPHERE ? "pack.domain.height"
                                                              : "pack.domain.radius",
                largest, component(edge, axis), "xyz"[axis]);
    if (domain->shape == DOMAIN_RING &&
        domain->radius - domain->inner_radius + slack < 2 * largest)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.domain.inner_radius: must leave room for a grain of radius "
                      "%g m, leaves %g m",
                      largest, domain->radius - domain->inner_radius);
    return STATUS_OK;
}

// ---- what is cut out ----------------------------------------------------------------

// A cylinder goes from bottom to top unless its ends are given; in two dimensions
// everything goes through the layer.
static enum status make_cut(const struct domain_parameters *parameters,
                            struct domain *domain, struct reason *reason)
{
    const bool flat = domain->dimensions == 2, box = domain->cut == CUT_BOX;
    if (flat && domain->cut == CUT_CYLINDER)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.domain.cut.shape: must be none, box or sphere (a disc) in "
                      "two dimensions");
    if (!box && isnan(parameters->cut_radius))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.domain.cut.radius: must be given, for this cut");
    const double radius = parameters->cut_radius;
    const struct vector half = {radius, radius, radius};
    const struct vector centre = isnan(parameters->cut_centre[0])
                                     ? domain->centre
                                     : as_vector(parameters->cut_centre);
    domain->cut_radius = radius;
    domain->cut_lower = box ? as_vector(parameters->cut_lower) : subtract(centre, half);
    domain->cut_upper = box ? as_vector(parameters->cut_upper) : add(centre, half);
    if (domain->cut == CUT_CYLINDER) {
        const double low = parameters->cut_lower[2], high = parameters->cut_upper[2];
        domain->cut_lower.z = isnan(low) ? domain->lower.z : low;
        domain->cut_upper.z = isnan(high) ? domain->upper.z : high;
    }
    if (flat) {
        domain->cut_lower.y = domain->lower.y;
        domain->cut_upper.y = domain->upper.y;
    }
    for (int axis = 0; axis < 3; axis++)
        if (!(component(domain->cut_lower, axis) < component(domain->cut_upper, axis)))
            return refuse(reason, STATUS_BAD_DATA,
                          "pack.domain.cut.upper: must be given and above "
                          "pack.domain.cut.lower along %c",
                          "xyz"[axis]);
    domain->cut_centre = midpoint(domain->cut_lower, domain->cut_upper);
    return STATUS_OK;
}

// Largest and smallest distance of the cut-out from the vertical axis of the domain, m.
static double cut_farthest(const struct domain *domain)
{
    const struct vector apart = subtract(domain->cut_centre, domain->centre);
    if (domain->cut != CUT_BOX) return across(apart.x, apart.y) + domain->cut_radius;
    const struct vector edge = subtract(domain->cut_upper, domain->cut_lower);
    return across(fabs(apart.x) + edge.x / 2, fabs(apart.y) + edge.y / 2);
}

// Not below 0 along either axis: the box may reach across the axis.
static double cut_nearest(const struct domain *domain)
{
    const struct vector apart = subtract(domain->cut_centre, domain->centre);
    if (domain->cut != CUT_BOX) return across(apart.x, apart.y) - domain->cut_radius;
    const struct vector edge = subtract(domain->cut_upper, domain->cut_lower);
    return across(fmax(fabs(apart.x) - edge.x / 2, 0),
                  fmax(fabs(apart.y) - edge.y / 2, 0));
}

// Largest distance of the cut-out from the centre of the domain, m. The farthest corner
// of a box, the rim of a cylinder, the far pole of a sphere.
static double cut_reach(const struct domain *domain)
{
    const struct vector apart = subtract(domain->cut_centre, domain->centre);
    const double flat = domain->dimensions == 2 ? 0 : 1;
    if (domain->cut == CUT_SPHERE)
        return norm((struct vector){apart.x, flat * apart.y, apart.z}) +
               domain->cut_radius;
    const struct vector edge = subtract(domain->cut_upper, domain->cut_lower);
    const double up = fabs(apart.z) + edge.z / 2;
    if (domain->cut == CUT_CYLINDER) return across(cut_farthest(domain), up);
    return norm((struct vector){fabs(apart.x) + edge.x / 2,
                                flat * (fabs(apart.y) + edge.y / 2), up});
}

// Refuses a cut-out that is not inside the domain: the volume would not be known. The
// box around the cut-out against the box of the domain, then round walls by distances.
static enum status check_cut(const struct domain *domain, struct reason *reason)
{
    const double slack = domain_rounding(domain);
    bool inside = true;
    for (int axis = 0; axis < 3; axis++)
        inside = inside &&
                 component(domain->cut_lower, axis) >=
                     component(domain->lower, axis) - slack &&
                 component(domain->cut_upper, axis) <=
                     component(domain->upper, axis) + slack;
    if (domain->shape == DOMAIN_CYLINDER || domain->shape == DOMAIN_RING)
        inside = inside && cut_farthest(domain) <= domain->radius + slack;
    if (domain->shape == DOMAIN_RING)
        inside = inside && cut_nearest(domain) >= domain->inner_radius - slack;
    if (domain->shape == DOMAIN_SPHERE)
        inside = inside && cut_reach(domain) <= domain->radius + slack;
    if (!inside)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.domain.cut.shape: must lie wholly inside the domain (a "
                      "cylinder may go from bottom to top)");
    return STATUS_OK;
}

static enum status cut_out(const struct domain_parameters *parameters,
                           struct domain *domain, struct reason *reason)
{
    domain->cut = (enum domain_cut)parameters->cut;
    if (domain->cut == CUT_NONE) return STATUS_OK;
    const enum status status = make_cut(parameters, domain, reason);
    return status ? status : check_cut(domain, reason);
}

// ---- making -------------------------------------------------------------------------

enum status domain_init(const struct domain_parameters *parameters, int dimensions,
                        double largest, struct domain *domain, struct reason *reason)
{
    *domain = (struct domain){.dimensions = dimensions,
                              .shape = (enum domain_shape)parameters->shape};
    for (int axis = 0; axis < 3; axis++)
        domain->periodic[axis] = parameters->periodic[axis];
    const bool box = domain->shape == DOMAIN_BOX;
    enum status status = box ? make_box(parameters, domain, largest, reason)
                             : make_round(parameters, domain, largest, reason);
    if (!status && box) domain->centre = midpoint(domain->lower, domain->upper);
    if (!status) status = check_room(domain, largest, reason);
    return status ? status : cut_out(parameters, domain, reason);
}

// For lattices by counts: the box follows from them and only the cut-out is the user's.
enum status domain_around(const struct domain_parameters *parameters, int dimensions,
                          struct vector lower, struct vector upper,
                          struct domain *domain, struct reason *reason)
{
    *domain = (struct domain){.dimensions = dimensions,
                              .lower = lower,
                              .upper = upper,
                              .centre = midpoint(lower, upper)};
    for (int axis = 0; axis < 3; axis++)
        domain->periodic[axis] = parameters->periodic[axis];
    return cut_out(parameters, domain, reason);
}
