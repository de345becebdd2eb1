// SPDX-License-Identifier: GPL-3.0-or-later
// Grains of INPUT as they are: read, scaled to metres, and given a box. The box of the
// file holds unless pack.lower or pack.upper replace a side; only a file without a box
// takes pack.periodic. The domain is that box with the bodies of the file, unless
// pack.domain names another shape or cuts something out.
//
// In this order: read_grains tells the format by its content, and puts walls where the
// grains end if the file has no box; convert_grains makes metres of units and radii of
// diameters; apply_box replaces sides. pack.lower and pack.upper come last because they
// are metres already and must not be scaled.
#include "import.h"

#include "artifacts/read_grains.h"
#include "basics/status.h"
#include "formats/grains.h"

#include <math.h>

// Whether pack.domain is left as it is by default.
static bool is_plain(const struct pack_parameters *parameters)
{
    return parameters->domain.shape == DOMAIN_BOX && parameters->domain.cut == CUT_NONE;
}

static void apply_box(struct packing *packing, const struct pack_parameters *parameters)
{
    for (int axis = 0; axis < 3; axis++) {
        if (!isnan(parameters->domain.lower[axis]))
            set_component(&packing->lower, axis, parameters->domain.lower[axis]);
        if (!isnan(parameters->domain.upper[axis]))
            set_component(&packing->upper, axis, parameters->domain.upper[axis]);
        const double low = component(packing->lower, axis);
        const double high = component(packing->upper, axis);
        if (!(low < high))
            die(STATUS_BAD_DATA,
                "pack.upper: must be above pack.lower = %g m along %c, got %g", low,
                "xyz"[axis], high);
    }
}

// Cylinders that went from end to end of the box, from BELOW to ABOVE, still do: a
// lower box cuts them.
static void fit_bodies(struct packing *packing, double below, double above)
{
    for (int k = 0; k < packing->n_body; k++) {
        struct body *body = &packing->body[k];
        if (body->shape != BODY_CYLINDER) continue;
        if (body->lower.z <= below) body->lower.z = packing->lower.z;
        if (body->upper.z >= above) body->upper.z = packing->upper.z;
    }
}

// What the input says of its own box stands; all false is the default, and says
// nothing.
static void warn_of_periodic(const char *path, const struct packing *packing,
                             const bool given[3])
{
    const uint8_t *own = packing->periodic;
    if (!given[0] && !given[1] && !given[2]) return;
    if (own[0] == given[0] && own[1] == given[1] && own[2] == given[2]) return;
    const char *const word[] = {"false", "true"};
    report("pack.periodic: has no effect: the box is that of %s, with periodic = "
           "[%s,%s,%s] (pack.slab cuts it across z)",
           input_name(path), word[own[0]], word[own[1]], word[own[2]]);
}

// Grains from text or from another packing; INPUTS gets what the provenance says of it.
static struct packing import(const char *path, const struct pack_parameters *parameters,
                             bool quiet, double *unit, json_t *inputs)
{
    bool has_box, diameters = parameters->import_diameters;
    struct packing packing = read_grains(path, "packing", parameters->frame, &has_box,
                                         unit, &diameters, inputs);
    if (parameters->import_scale != 1) *unit = 0;
    for (int axis = 0; axis < 3 && !has_box; axis++)
        packing.periodic[axis] = parameters->domain.periodic[axis];
    if (has_box && !quiet)
        warn_of_periodic(path, &packing, parameters->domain.periodic);
    convert_grains(&packing, parameters->import_scale, diameters, has_box);
    refuse_large_radii(&packing, path);
    const double below = packing.lower.z, above = packing.upper.z;
    apply_box(&packing, parameters);
    if (is_plain(parameters)) fit_bodies(&packing, below, above);
    return packing;
}

// The domain that the bodies of INPUT, of which the box may have been changed, bound.
static struct domain keep_bodies(const struct pack_parameters *parameters,
                                 struct packing *packing, const char *path)
{
    struct domain domain;
    if (!domain_of(packing, (int)parameters->dimensions, &domain))
        die(STATUS_BAD_DATA,
            "%s: /domain/bodies: must be at most one cylinder or sphere around the "
            "grains, within the box, and one body cut out (pack.domain replaces them)",
            input_name(path));
    packing->lower = domain.lower;
    packing->upper = domain.upper;
    return domain;
}

// The domain of the parameters in place of the bodies of PACKING. Round ones stand in
// the middle of its box unless they have a centre.
static struct domain replace_bodies(const struct pack_parameters *parameters,
                                    struct packing *packing)
{
    struct domain_parameters given = parameters->domain;
    const struct vector middle = midpoint(packing->lower, packing->upper);
    double largest = 0;
    for (int i = 0; i < packing->n_particle; i++)
        largest = fmax(largest, packing->radius[i]);
    for (int axis = 0; axis < 3; axis++) {
        given.periodic[axis] = packing->periodic[axis];
        if (isnan(parameters->domain.centre[0]))
            given.centre[axis] = component(middle, axis);
    }
    struct domain domain;
    struct reason reason;
    const int dimensions = (int)parameters->dimensions;
    const enum status status =
        given.shape == DOMAIN_BOX
            ? domain_around(&given, dimensions, packing->lower, packing->upper, &domain,
                            &reason)
            : domain_init(&given, dimensions, largest, &domain, &reason);
    if (status) die(status, "%s", reason.text);
    packing->lower = domain.lower;
    packing->upper = domain.upper;
    return domain;
}

struct packing make_import(const struct invocation *invocation,
                           const struct pack_parameters *parameters, json_t *inputs,
                           struct domain *domain, double *unit)
{
    const char *path = invocation->n_input ? invocation->inputs[0] : "-";
    struct packing packing = import(path, parameters, invocation->quiet, unit, inputs);
    *domain = is_plain(parameters) ? keep_bodies(parameters, &packing, path)
                                   : replace_bodies(parameters, &packing);
    packing.n_body = domain_bodies(domain, packing.body);
    return packing;
}
