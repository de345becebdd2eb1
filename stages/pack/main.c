// SPDX-License-Identifier: GPL-3.0-or-later
// pack: grains in a box, and the bonds between them.
#include "artifacts/artifact.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "pack.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum method { METHOD_SQUARE, METHOD_CUBIC, METHOD_IMPORT };
enum bonds { BONDS_NONE, BONDS_TOUCHING, BONDS_KEEP };

struct pack_parameters {
    int method, bonds;
    int64_t counts[3];
    double radius;
    bool periodic[3];
    double lower[3], upper[3];
    double touching_gap;
};

#define AT(member) offsetof(struct pack_parameters, member)

static const struct parameter table[] = {
    {"method", PARAMETER_CHOICE, "1", "\"cubic\"", BOUND_NONE, 0, 0,
     "square|cubic|import",
     "lattice of touching grains (square: one layer in x and z), or grains from INPUT",
     AT(method)},
    {"counts", PARAMETER_COUNTS, "1", "[5,5,10]", BOUND_BETWEEN, 1, 1e6, NULL,
     "grains along x, y and z of a lattice", AT(counts)},
    {"radius", PARAMETER_NUMBER, "m", "250e-9", BOUND_ABOVE, 0, 0, NULL,
     "grain radius of a lattice", AT(radius)},
    {"periodic", PARAMETER_FLAGS, "1", "[false,false,false]", BOUND_NONE, 0, 0, NULL,
     "whether the box repeats along x, y and z (imported packing.h5: as it says)",
     AT(periodic)},
    {"lower", PARAMETER_POINT, "m", "null", BOUND_NONE, 0, 0, NULL,
     "lower corner of the box of imported grains; null: around them", AT(lower)},
    {"upper", PARAMETER_POINT, "m", "null", BOUND_NONE, 0, 0, NULL,
     "upper corner of the box of imported grains; null: around them", AT(upper)},
    {"bonds", PARAMETER_CHOICE, "1", "\"touching\"", BOUND_NONE, 0, 0,
     "none|touching|keep",
     "which grains are bonded; keep: as an imported packing.h5 says", AT(bonds)},
    {"touching_gap", PARAMETER_NUMBER, "1", "1e-6", BOUND_BETWEEN, 0, 1, NULL,
     "surfaces this close touch, of the sum of the two radii", AT(touching_gap)},
    {0}};

static const struct stage stage = {
    .name = "pack",
    .version = STAGE_VERSION,
    .summary = "pack -- grains in a box, and the bonds between them",
    .writes = "packing",
    .most_inputs = 1,
    .parameters = table,
    .notes = "INPUT, with method=import: text of \"x y z r\" lines (# comments), or a "
             "packing.h5."};

static struct packing make_lattice(const struct pack_parameters *parameters)
{
    const int64_t *counts = parameters->counts;
    if (parameters->method == METHOD_SQUARE && counts[1] != 1)
        die(STATUS_BAD_DATA,
            "pack.counts: a square lattice is one layer: must be 1 along "
            "y, got %lld",
            (long long)counts[1]);
    if ((double)counts[0] * (double)counts[1] * (double)counts[2] > 1e8)
        die(STATUS_BAD_DATA, "pack.counts: must make at most 1e8 grains");
    return cubic_lattice(counts, parameters->radius, parameters->periodic);
}

static bool is_hdf5(const struct bytes *bytes)
{
    return bytes->size >= 4 && !memcmp(bytes->data, "\x89HDF", 4);
}

static void apply_box(struct packing *packing, const struct pack_parameters *parameters)
{
    for (int axis = 0; axis < 3; axis++) {
        if (!isnan(parameters->lower[axis]))
            set_component(&packing->lower, axis, parameters->lower[axis]);
        if (!isnan(parameters->upper[axis]))
            set_component(&packing->upper, axis, parameters->upper[axis]);
        const double low = component(packing->lower, axis);
        const double high = component(packing->upper, axis);
        if (!(low < high))
            die(STATUS_BAD_DATA,
                "pack.upper: must be above pack.lower = %g m along %c, got %g", low,
                "xyz"[axis], high);
    }
}

static struct packing import_lines(const char *path, struct bytes text,
                                   const struct pack_parameters *parameters,
                                   json_t *inputs)
{
    struct packing packing;
    struct reason reason;
    const enum status status = import_text(&text, &packing, &reason);
    if (status) die(status, "%s: %s", input_name(path), reason.text);
    for (int axis = 0; axis < 3; axis++)
        packing.periodic[axis] = parameters->periodic[axis];
    char digest[65];
    sha256(text.data, text.size, digest);
    json_array_append_new(inputs,
                          json_pack("{s:s,s:s}", "schema", "text", "sha256", digest));
    free(text.data);
    return packing;
}

static struct packing import_packing(const char *path, struct bytes image,
                                     json_t *inputs)
{
    struct artifact *origin = artifact_open_bytes(path, image, "packing");
    const struct packing packing = artifact_get_packing(origin);
    json_array_append_new(inputs, input_digest(origin));
    artifact_close(origin);
    return packing;
}

// Grains from text or from another packing; INPUTS gets what the provenance says of it.
static struct packing import(const char *path, const struct pack_parameters *parameters,
                             json_t *inputs)
{
    const struct bytes bytes = read_whole(path);
    struct packing packing = is_hdf5(&bytes)
                                 ? import_packing(path, bytes, inputs)
                                 : import_lines(path, bytes, parameters, inputs);
    apply_box(&packing, parameters);
    return packing;
}

static struct packing make_packing(const struct invocation *invocation,
                                   const struct pack_parameters *parameters,
                                   json_t *inputs)
{
    if (parameters->method == METHOD_IMPORT)
        return import(invocation->n_input ? invocation->inputs[0] : "-", parameters,
                      inputs);
    if (invocation->n_input)
        die(STATUS_USAGE, "%s: only method=import takes an input",
            invocation->inputs[0]);
    return make_lattice(parameters);
}

static void write_packing(const struct packing *packing,
                          const struct invocation *invocation, json_t *inputs,
                          double touching_gap)
{
    const double porosity = packing_porosity(packing);
    if (!(porosity > -1e6))
        die(STATUS_BAD_DATA, "the box is too small for its grains: the porosity is %g",
            porosity);
    double max_overlap, coordination;
    packing_contacts(packing, touching_gap, &max_overlap, &coordination);

    struct artifact *artifact = artifact_create("packing");
    artifact_put_packing(artifact, packing);
    artifact_put_number(artifact, "/summary/porosity", porosity);
    artifact_put_number(artifact, "/summary/max_overlap", max_overlap);
    artifact_put_number(artifact, "/summary/coordination", coordination);
    artifact_put_number(artifact, "/summary/unbalanced_ratio", 0);
    artifact_put_vtk(artifact, "/particles/position", packing->n_particle,
                     (const char *const[]){"/particles/radius", NULL}, NULL, 0, NULL);
    artifact_finish(artifact, invocation, inputs,
                    "grains are where the method puts them: no dynamics was run\n");
}

int main(int argc, char **argv)
{
    struct pack_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    json_t *inputs = json_array();

    struct packing packing = make_packing(&invocation, &parameters, inputs);
    if (parameters.bonds == BONDS_TOUCHING)
        bond_touching(&packing, parameters.touching_gap);
    if (parameters.bonds == BONDS_NONE) packing.n_bond = 0;
    if (parameters.bonds == BONDS_TOUCHING && !packing.n_bond &&
        packing.n_particle > 1 && !invocation.quiet)
        report("no two grains touch within touching_gap = %g: no bonds",
               parameters.touching_gap);
    write_packing(&packing, &invocation, inputs, parameters.touching_gap);

    packing_free(&packing);
    invocation_free(&invocation);
    return STATUS_OK;
}
