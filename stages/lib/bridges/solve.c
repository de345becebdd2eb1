// SPDX-License-Identifier: GPL-3.0-or-later
// The exact bridge in SI: bodies in effective radii r = 2 / (1/R1 + 1/R2) go to
// equilibrium.c, and come back as
//     force = 2 pi gamma r (arc_force - H rho^2),  suction = 2 gamma H / r,
//     energy = gamma (free area - sum of cos theta wetted area),
// with H = turn / length, and rho the radius of the circle in which overlapping bodies
// meet (the liquid does not press there).
#include "bridges/bridges.h"
#include "bridges/equilibrium.h"

#include <math.h>

// Outside this range intermediate results overflow or underflow.
static const double LEAST_VOLUME = 1e-60, MOST_VOLUME = 1e100;

enum status bridge_check(const struct bridge *bridge, struct reason *reason)
{
    for (int k = 0; k < 2; k++) {
        if (!(bridge->radius[k] > 0))
            return refuse(reason, STATUS_BAD_DATA, "radius must be positive, is %g m",
                          bridge->radius[k]);
        if (!(bridge->contact_angle[k] >= 0 && bridge->contact_angle[k] < M_PI))
            return refuse(reason, STATUS_BAD_DATA,
                          "contact angle must be from 0 to less than pi, is %g",
                          bridge->contact_angle[k]);
    }
    if (!isfinite(bridge_effective_radius(bridge)))
        return refuse(reason, STATUS_BAD_DATA, "two planes hold no bridge");
    if (!(bridge->volume > 0))
        return refuse(reason, STATUS_BAD_DATA, "volume must be positive, is %g m3",
                      bridge->volume);
    const double volume = bridge_dimensionless_volume(bridge);
    if (!(volume >= LEAST_VOLUME && volume <= MOST_VOLUME))
        return refuse(reason, STATUS_BAD_DATA,
                      "volume must be from %g to %g times the cube of the effective "
                      "radius (%g m), is %g m3",
                      LEAST_VOLUME, MOST_VOLUME, bridge_effective_radius(bridge),
                      bridge->volume);
    return STATUS_OK;
}

static struct bodies bodies_of(const struct bridge *bridge)
{
    const double scale = bridge_effective_radius(bridge);
    return (struct bodies){{scale / bridge->radius[0], scale / bridge->radius[1]},
                           {bridge->contact_angle[0], bridge->contact_angle[1]}};
}

static struct bridge_state state_of(const struct bridge *bridge,
                                    const struct bodies *bodies,
                                    const struct equilibrium *found)
{
    const double scale = bridge_effective_radius(bridge);
    const double tension = bridge->surface_tension;
    const struct arc *arc = &found->arc;
    const double curvature = arc->turn / arc->length;
    const double shared = bodies_overlap(bodies, found->gap).radius_squared;
    struct bridge_state state = {.separation = found->gap * scale,
                                 .force = 2 * M_PI * tension * scale *
                                          (arc_force(bodies, arc) - curvature * shared),
                                 .suction = 2 * tension * curvature / scale,
                                 .neck_radius = scale * arc_neck(bodies, arc),
                                 .free_area = scale * scale * span_of(bodies, arc).area,
                                 .arc = *arc,
                                 .steps = found->steps};
    state.energy = tension * state.free_area;
    for (int k = 0; k < 2; k++) {
        const struct contact_line line = contact_line(bodies, k, arc->reach[k]);
        state.half_filling_angle[k] = line.angle;
        state.contact_radius[k] = scale * line.radius;
        state.wetted_area[k] = scale * scale * line.wet_area;
        state.energy -= tension * cos(bodies->contact_angle[k]) * state.wetted_area[k];
    }
    return state;
}

enum status bridge_solve(const struct bridge *bridge, double separation,
                         struct bridge_state *state, struct reason *reason)
{
    const enum status bad = bridge_check(bridge, reason);
    if (bad) return bad;
    const struct bodies bodies = bodies_of(bridge);
    const double gap = separation / bridge_effective_radius(bridge);
    struct equilibrium found;
    const enum status status =
        find_equilibrium(&bodies, bridge_dimensionless_volume(bridge), gap, &found);
    *state = state_of(bridge, &bodies, &found);
    if (status == STATUS_NO)
        return refuse(reason, status,
                      "no bridge of %g m3 at separation %g m: it ruptures at %g m",
                      bridge->volume, separation, state->separation);
    if (status)
        return refuse(reason, status,
                      "no equilibrium found for %g m3 at separation %g m",
                      bridge->volume, separation);
    state->separation = separation;
    return STATUS_OK;
}

enum status bridge_at_suction(const struct bridge *bridge, double separation,
                              double suction, struct bridge_state *state,
                              double *volume, struct reason *reason)
{
    const double scale = bridge_effective_radius(bridge);
    const struct bodies bodies = bodies_of(bridge);
    const double curvature = scale * suction / (2 * bridge->surface_tension);
    struct equilibrium found;
    const enum status status =
        find_at_curvature(&bodies, curvature, separation / scale, &found, volume);
    if (status)
        return refuse(reason, status,
                      "no bridge at separation %g m holds out against a suction of "
                      "%g Pa",
                      separation, suction);
    *state = state_of(bridge, &bodies, &found);
    *volume *= scale * scale * scale;
    return STATUS_OK;
}

// The volume nearest to VOLUME, to 2 %, at which rupture is found, if it is at 1: both
// over the cube of the effective radius.
static double nearest_that_ruptures(const struct bodies *bodies, double volume)
{
    double found = 0, failed = log(volume); // logarithms
    while (fabs(failed - found) > 0.02) {
        const double middle = 0.5 * (found + failed);
        struct equilibrium unused;
        if (find_rupture(bodies, exp(middle), &unused) == STATUS_OK)
            found = middle;
        else
            failed = middle;
    }
    return exp(found);
}

enum status bridge_solve_rupture(const struct bridge *bridge,
                                 struct bridge_state *state, struct reason *reason)
{
    const enum status bad = bridge_check(bridge, reason);
    if (bad) return bad;
    const struct bodies bodies = bodies_of(bridge);
    struct equilibrium found;
    const enum status status =
        find_rupture(&bodies, bridge_dimensionless_volume(bridge), &found);
    *state = state_of(bridge, &bodies, &found);
    if (status == STATUS_OK) return STATUS_OK;
    const double volume = bridge_dimensionless_volume(bridge);
    const double nearest = nearest_that_ruptures(&bodies, volume);
    return refuse(reason, status,
                  "no rupture found for %g m3, %.3g times the cube of the effective "
                  "radius: between these bodies it is %s %.3g times (%.3g m3)",
                  bridge->volume, volume, nearest < volume ? "up to" : "from", nearest,
                  bridge->volume / volume * nearest);
}

void bridge_profile(const struct bridge *bridge, const struct bridge_state *state,
                    int count, double *height, double *radius)
{
    const double scale = bridge_effective_radius(bridge);
    const struct bodies bodies = bodies_of(bridge);
    arc_profile(&bodies, &state->arc, count, height, radius);
    for (int k = 0; k < count; k++) {
        height[k] *= scale;
        radius[k] *= scale;
    }
}
