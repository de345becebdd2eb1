// SPDX-License-Identifier: GPL-3.0-or-later
// Grains of INPUT as they are: read, scaled to metres, and given a box. The box of the
// file holds unless pack.lower or pack.upper replace a side; only a file without a box
// takes pack.periodic. The domain is that box, with nothing cut out.
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

// Grains from text or from another packing; INPUTS gets what the provenance says of it.
static struct packing import(const char *path, const struct pack_parameters *parameters,
                             json_t *inputs)
{
    bool has_box;
    struct packing packing =
        read_grains(path, "packing", parameters->frame, &has_box, inputs);
    for (int axis = 0; axis < 3 && !has_box; axis++)
        packing.periodic[axis] = parameters->domain.periodic[axis];
    convert_grains(&packing, parameters->import_scale, parameters->import_diameters,
                   has_box);
    refuse_large_radii(&packing, path);
    apply_box(&packing, parameters);
    return packing;
}

struct packing make_import(const struct invocation *invocation,
                           const struct pack_parameters *parameters, json_t *inputs,
                           struct domain *domain)
{
    if (parameters->domain.shape != DOMAIN_BOX || parameters->domain.cut != CUT_NONE)
        die(STATUS_BAD_DATA,
            "pack.domain.shape: must be box, and nothing cut out, for import");
    const struct packing packing =
        import(invocation->n_input ? invocation->inputs[0] : "-", parameters, inputs);
    *domain = (struct domain){.dimensions = (int)parameters->dimensions,
                              .lower = packing.lower,
                              .upper = packing.upper,
                              .centre = scale(0.5, add(packing.lower, packing.upper))};
    for (int axis = 0; axis < 3; axis++)
        domain->periodic[axis] = packing.periodic[axis];
    return packing;
}
