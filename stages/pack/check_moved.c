// SPDX-License-Identifier: GPL-3.0-or-later
// Refuses targets that moving grains cannot reach, before they are moved.
//
// Coordination: touching spheres of any sizes have fewer than 8 + 4 sqrt(3) contacts on
// average, discs fewer than 6. Pressure: with overlaps of a tenth,
//     pressure = 0.1 stiffness / (4 smallest radius).
// Periodic boxes must be 2.4 largest diameters wide, as the engine knows one image of
// each neighbour.
#include "methods.h"
#include "pack.h"

#include <math.h>

static bool is_compressed(const struct pack_parameters *parameters)
{
    return parameters->method == METHOD_RADIUS_EXPANSION ||
           parameters->method == METHOD_DOMAIN_CONTRACTION;
}

// Touching spheres of any sizes have fewer contacts on average than 8 + 4 sqrt 3
// [Kuperberg & Schramm 1994], discs fewer than 6 (their contact graph is planar:
// Euler).
static enum status check_coordination(const struct pack_parameters *parameters,
                                      struct reason *reason)
{
    const double most = parameters->dimensions == 2 ? 6 : 8 + 4 * sqrt(3);
    if (parameters->dynamics.value < most) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "pack.target_value: must be below %.3g contacts a grain, got %g",
                  most, parameters->dynamics.value);
}

// A pressure at which grains of the given stiffness would overlap by a tenth.
static enum status check_pressure(const struct pack_parameters *parameters,
                                  const struct sizes *sizes, struct reason *reason)
{
    const struct dynamics_parameters *how = &parameters->dynamics;
    const double most = 0.1 * how->stiffness / (4 * sizes->smallest);
    if (isnan(how->stiffness) || how->value <= most) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "pack.target_value: must be at most %g Pa for "
                  "pack.dynamics.stiffness: grains would overlap by a tenth, got %g",
                  most, how->value);
}

static enum status check_target(const struct pack_parameters *parameters,
                                const struct sizes *sizes, struct reason *reason)
{
    const struct dynamics_parameters *how = &parameters->dynamics;
    if (how->target == TARGET_SETTLED && !isnan(how->value))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.target_value: must be null where pack.target is settled");
    if (how->target == TARGET_COORDINATION)
        return check_coordination(parameters, reason);
    if (how->target == TARGET_PRESSURE)
        return check_pressure(parameters, sizes, reason);
    return STATUS_OK;
}

// The engine knows one image of each neighbour, so the box must be wide enough.
static enum status check_periods(const struct domain *domain, const struct sizes *sizes,
                                 struct reason *reason)
{
    const double least = 4.8 * sizes->largest;
    const bool tails =
        sizes->distribution == SIZES_NORMAL || sizes->distribution == SIZES_LOGNORMAL;
    const struct vector edge = subtract(domain->upper, domain->lower);
    for (int axis = 0; axis < 3; axis++)
        if (domain->periodic[axis] && component(edge, axis) < least)
            return refuse(reason, STATUS_BAD_DATA,
                          "pack.upper: must make a box of at least %g m along %c, "
                          "which repeats: 2.4 of the largest diameter that pack.sizes "
                          "allows, %g m, got %g%s",
                          least, "xyz"[axis], least / 2.4, component(edge, axis),
                          tails ? "; pack.sizes.largest cuts off larger grains" : "");
    return STATUS_OK;
}

enum status check_moved(const struct pack_parameters *parameters, const char *given,
                        const struct domain *domain, const struct sizes *sizes,
                        struct reason *reason)
{
    if (parameters->method == METHOD_DEPOSITION && domain->periodic[2])
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.periodic: must be false along z for deposition: grains "
                      "need a floor");
    if (given && parameters->method == METHOD_RADIUS_EXPANSION &&
        (domain->shape != DOMAIN_BOX || domain->cut != CUT_NONE))
        return refuse(
            reason, STATUS_BAD_DATA,
            "pack.domain.shape: must be box, and nothing cut out, for radius_expansion "
            "of %s, whose box shrinks with the grains (deposition keeps the shape)",
            given);
    if (given && parameters->method == METHOD_RADIUS_EXPANSION &&
        parameters->dynamics.target == TARGET_PRESSURE)
        return refuse(
            reason, STATUS_BAD_DATA,
            "pack.target: must not be pressure for radius_expansion of %s, whose "
            "lengths are scaled back at the end (domain_contraction)",
            given);
    enum status status = parameters->extra_layer
                             ? check_layer(domain, parameters->extra_side, reason)
                             : STATUS_OK;
    if (!status) status = check_target(parameters, sizes, reason);
    if (status != STATUS_OK || !is_compressed(parameters)) return status;
    return check_periods(domain, sizes, reason);
}
