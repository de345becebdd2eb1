// SPDX-License-Identifier: GPL-3.0-or-later
// pack: grains in a box, and the bonds between them.
//
// In this order: grains of INPUT, if the method takes any; the checkpoint; the method;
// contacts; the check of the packing; bonds; the extra layer, which comes after the
// bonds because it has none; then the artifact and the report. Measures are those of
// the body without auxiliary grains, in the box that ends where it does.
//
// INPUT (text, a LAMMPS dump or a packing.h5) is the packing itself with import, and
// where moving grains begin with the methods that move them; no other method takes one.
// A slab is cut before contacts are searched: what is left of the grains has other
// numbers, and its bonds are made anew. The packing artifact has grains, box, bonds,
// the walls of the domain as bodies, and /summary and /structure (report.c); --report
// writes these two as JSON.
//
// All that is random follows from `seed`. Exits 65 for parameters or grains that cannot
// be, 3 for a method that did not get where it should; nothing is written then.
#include "artifacts/artifact.h"
#include "artifacts/checkpoint.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "dynamics.h"
#include "geometry/auxiliary.h"
#include "geometry/fabric.h"
#include "geometry/packing_check.h"
#include "import.h"
#include "methods.h"
#include "pack.h"
#include "parameters.h"
#include "parameters/estimate.h"
#include "report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct stage stage = {
    .name = "pack",
    .version = STAGE_VERSION,
    .summary = "pack -- grains in a box, and the bonds between them",
    .writes = "packing",
    .most_inputs = 1,
    .parameters = pack_table,
    .estimates = ESTIMATES_SIZES,
    .notes = "INPUT, with method=import: text of \"x y z r\" lines (# comments; below "
             "names of columns "
             "any others, too), a LAMMPS "
             "dump in text (columns x y z or xu, xs, xsu; radius or diameter), or a "
             "packing.h5. With deposition, radius_expansion, domain_contraction and "
             "explosive_repulsion the same, for grains to begin from.",
    .reports = "Write the report of the packing there, as JSON",
    .checkpoints = true};

static bool moves_grains(int method)
{
    return method == METHOD_DEPOSITION || method == METHOD_RADIUS_EXPANSION ||
           method == METHOD_DOMAIN_CONTRACTION || method == METHOD_EXPLOSIVE_REPULSION;
}

// Name of the input that grains come from, to stay where they are or to be moved, or
// NULL.
static const char *given_input(const struct invocation *invocation, int method)
{
    const char *path = invocation->n_input ? invocation->inputs[0] : NULL;
    if (method == METHOD_IMPORT) return input_name(path ? path : "-");
    if (path && !moves_grains(method))
        die(STATUS_USAGE,
            "%s: this pack.method (by default cubic) takes no input: import, "
            "deposition, "
            "radius_expansion, domain_contraction and explosive_repulsion do",
            path);
    return path ? input_name(path) : NULL;
}

// Any method but import. If GIVEN, PACKING and DOMAIN hold the grains to begin with.
static void make_packing(const struct invocation *invocation,
                         const struct pack_parameters *parameters, const char *given,
                         struct domain *domain, struct packing *packing,
                         struct reached *reached)
{
    struct progress progress = progress_begin(invocation->progress, invocation->quiet);
    struct reason reason;
    const enum status status =
        make_grains(parameters, given, &progress, domain, packing, reached, &reason);
    progress_end(&progress);
    const struct keeper *keeper = parameters->dynamics.keeper;
    if (status == STATUS_BAD_DATA && keeper->begin) // only what was kept can be
        die(status, "%s: %s", invocation->checkpoint, reason.text);
    if (status) die(status, "%s", reason.text);
}

// Porosity of the domain, not of the box around it. For a box the porosity is returned
// as it is, so that no digit is lost.
static double porosity_in(const struct domain *domain, const struct packing *packing)
{
    const double porosity = packing_porosity(packing);
    if (domain->shape == DOMAIN_BOX && domain->cut == CUT_NONE) return porosity;
    const struct vector edge = subtract(packing->upper, packing->lower);
    return 1 - (1 - porosity) * (box_volume(edge) / domain_volume(domain));
}

// Methods that keep box and radii reach a porosity by the number of grains alone.
static void tell_porosity(const struct pack_parameters *parameters,
                          const struct domain *domain, const struct packing *packing)
{
    const double wanted = parameters->dynamics.value;
    if (parameters->method != METHOD_SOFT_SPHERES &&
        parameters->method != METHOD_EXPLOSIVE_REPULSION)
        return;
    if (parameters->dynamics.target != TARGET_POROSITY) return;
    const double porosity = 1 - solid_fraction(domain, packing);
    if (!(fabs(porosity - wanted) > 0.01)) return;
    report("pack.target_value: asks for a porosity of %g, but %d grains leave %.3g of "
           "the box: %s",
           wanted, packing->n_particle, porosity,
           parameters->count
               ? "without pack.count as many are taken as it needs"
               : "one is large beside it (another pack.seed, a larger box, or "
                 "pack.sizes.largest)");
}

// What the dynamics came to, for the report; NULL when there was none.
static json_t *reached_json(const struct pack_parameters *parameters,
                            const struct reached *reached)
{
    static const char *const target[] = {"settled", "porosity", "coordination",
                                         "pressure"};
    if (!reached->dynamic) return NULL;
    const double wanted = parameters->dynamics.value;
    return json_pack("{s:s,s:o,s:f,s:f,s:I,s:f,s:f,s:f,s:f,s:f,s:f}", "target",
                     target[parameters->dynamics.target], "wanted",
                     isnan(wanted) ? json_null() : json_real(wanted), "value",
                     reached->value, "unbalanced_ratio", reached->unbalanced_ratio,
                     "cycles", (json_int_t)reached->cycles, "simulated_time",
                     reached->time, "time_step", reached->time_step, "stiffness",
                     reached->stiffness, "largest_speed", reached->largest_speed,
                     "pressure", reached->pressure, "growth", reached->growth);
}

// Whether contacts had friction as grains moved: explosive repulsion has none.
static bool moved_with_friction(const struct pack_parameters *parameters)
{
    return parameters->dynamics.friction > 0 &&
           parameters->method != METHOD_EXPLOSIVE_REPULSION;
}

static const char *model_text(const struct reached *reached,
                              const struct pack_parameters *parameters)
{
    if (!reached->dynamic)
        return "grains are where the method puts them: no dynamics was run\n";
    if (moved_with_friction(parameters))
        return "grains moved by discrete elements: linear contacts [K 4.22], dashpots "
               "[K 4.27], Coulomb slip [K 4.25]\nno bonds while they moved\n";
    return "grains moved by discrete elements: linear contacts [K 4.22], dashpots [K "
           "4.27]\nwithout friction grains do not turn and contacts have no "
           "history\nno bonds while they moved\n";
}

// Refuses a packing that is impossible, and warns of one that is hardly meant. Before
// bonds and layer are made: a wrong unit or a diameter for a radius should be told
// first. Notes, the mildest findings, are not told here.
static void look_at(const struct packing *packing, const struct contacts *contacts,
                    const struct invocation *invocation,
                    const struct pack_parameters *parameters, double unit)
{
    // random points are meant to overlap
    if (parameters->check == CHECK_NONE || parameters->method == METHOD_POISSON) return;
    const char *path = invocation->n_input ? input_name(invocation->inputs[0]) : NULL;
    struct packing_facts facts =
        packing_facts(packing, contacts, parameters->touching_gap);
    facts.unit = unit;
    struct findings findings = {0};
    judge_packing(packing, &facts, &findings);
    for (int k = 0; k < findings.count; k++) {
        const struct finding *finding = &findings.item[k];
        if (finding->severity == FINDING_IMPOSSIBLE &&
            parameters->check == CHECK_REFUSE)
            die(STATUS_BAD_DATA, "%s%s%s", path ? path : "", path ? ": " : "",
                finding->text);
        if (finding->severity != FINDING_NOTE && !invocation->quiet)
            report("%s%s%s", path ? path : "", path ? ": " : "", finding->text);
    }
}

// Measures PACKING in DOMAIN, neither of which has auxiliary grains.
static struct packing_report measure(const struct packing *packing,
                                     const struct domain *domain,
                                     const struct contacts *contacts,
                                     const struct pack_parameters *parameters,
                                     const struct reached *reached)
{
    const double porosity = porosity_in(domain, packing);
    if (!(porosity > -1e6))
        die(STATUS_BAD_DATA, "the box is too small for its grains: the porosity is %g",
            porosity);
    struct packing_report entry =
        report_packing(packing, domain, contacts, parameters->touching_gap,
                       reached->dynamic && moved_with_friction(parameters));
    report_number(&entry, "/summary/porosity", porosity);
    report_number(&entry, "/summary/unbalanced_ratio", reached->unbalanced_ratio);
    return entry;
}

// The same below auxiliary layers, in the part of the domain that they leave.
static struct packing_report measure_body(const struct packing *packing,
                                          const struct domain *domain,
                                          const struct pack_parameters *parameters,
                                          const struct reached *reached)
{
    struct packing body = without_auxiliary(packing);
    const struct window box = box_without_auxiliary(packing);
    struct domain left = *domain;
    body.lower = left.lower = box.lower;
    body.upper = left.upper = box.upper;
    struct contacts contacts = find_contacts(&body, parameters->touching_gap);
    struct packing_report entry = measure(&body, &left, &contacts, parameters, reached);
    free((void *)contacts.pair);
    packing_free(&body);
    return entry;
}

static void write_packing(const struct packing *packing, const struct domain *domain,
                          const struct contacts *contacts,
                          const struct invocation *invocation, json_t *inputs,
                          const struct pack_parameters *parameters,
                          const struct reached *reached)
{
    struct packing_report entry =
        packing->kind ? measure_body(packing, domain, parameters, reached)
                      : measure(packing, domain, contacts, parameters, reached);

    struct artifact *artifact = artifact_create("packing", invocation->output);
    artifact_put_packing(artifact, packing);
    report_put(&entry, artifact);
    artifact_put_vtk(artifact, "/particles/position", packing->n_particle,
                     (const char *const[]){"/particles/radius", NULL}, NULL, 0, NULL);
    artifact_finish(artifact, invocation, inputs, model_text(reached, parameters));
    if (invocation->report)
        report_write(&entry, invocation->report, reached_json(parameters, reached));
    report_free(&entry);
}

// With bonds=keep those of INPUT stay, if no grain has moved and no slab was cut. No
// touching pair at all is told: nothing could crack.
static void make_bonds(struct packing *packing, const struct contacts *contacts,
                       const struct pack_parameters *parameters, bool quiet)
{
    if (parameters->bonds == BONDS_NONE) packing->n_bond = 0;
    if (parameters->bonds != BONDS_TOUCHING) return;
    bond_contacts(packing, contacts);
    if (!packing->n_bond && packing->n_particle > 1 && !quiet)
        report("no two grains touch within touching_gap = %g: no bonds",
               parameters->touching_gap);
}

// Reports a porosity that is more than 0.01 above that of the same grains between the
// heights of the cut: the rest is void between grains and a flat end.
static void tell_ends(const struct pack_parameters *parameters,
                      const struct packing *packing)
{
    const double lower = packing->lower.z, upper = packing->upper.z;
    const double low = fmax(parameters->slab_lower, lower); // NAN: not cut there
    const double high = fmin(parameters->slab_upper, upper);
    const double porosity = packing_porosity(packing);
    const double within = 1 - (1 - porosity) * (upper - lower) / (high - low);
    if (!(high > low) || !(porosity - within > 0.01)) return;
    report(
        "pack.slab: the box ends on the outermost grains: its porosity is %.3g, %.3g "
        "between the heights of the cut; more liquid will fill it than a body of such "
        "grains holds, unless it ends there (docs/packings.md#slabs)",
        porosity, within);
}

static void take_slab(const struct pack_parameters *parameters, struct domain *domain,
                      struct packing *packing, bool quiet)
{
    const double lower = parameters->slab_lower, upper = parameters->slab_upper;
    struct reason reason;
    const enum status status = cut_slab(lower, upper, domain, packing, &reason);
    if (status) die(status, "%s", reason.text);
    if (isnan(lower) && isnan(upper)) return;
    if (parameters->check != CHECK_NONE && !quiet) tell_ends(parameters, packing);
}

// The domain grows with the box. The layer has no bonds: it only gives the boundary
// layer its nodes.
static void make_layer(struct domain *domain, int wall, struct packing *packing)
{
    struct reason reason;
    const enum status status = add_layer(domain, wall, packing, &reason);
    if (status) die(status, "%s", reason.text);
    domain->lower = packing->lower;
    domain->upper = packing->upper;
    packing->n_body = domain_bodies(domain, packing->body);
}

// Whether METHOD keeps checkpoints; the others run in one go.
static bool keeps_state(int method)
{
    return method == METHOD_DEPOSITION || method == METHOD_RADIUS_EXPANSION ||
           method == METHOD_DOMAIN_CONTRACTION;
}

// The caller ends it with checkpoint_end.
static void begin_checkpoint(struct checkpoint *checkpoint,
                             struct invocation *invocation, json_t *inputs, int method)
{
    if (invocation->checkpoint && !keeps_state(method)) {
        if (!invocation->quiet)
            report("--checkpoint: this method is done in one go, none is kept");
        invocation->checkpoint = NULL;
    }
    checkpoint_begin(checkpoint, invocation, inputs);
}

static enum moving moving_of(int method)
{
    switch (method) {
    case METHOD_DEPOSITION:
        return MOVING_BY_GRAVITY;
    case METHOD_RADIUS_EXPANSION:
    case METHOD_DOMAIN_CONTRACTION:
        return MOVING_BY_COMPRESSION;
    case METHOD_EXPLOSIVE_REPULSION:
        return MOVING_BY_OVERLAPS;
    case METHOD_SOFT_SPHERES:
        return MOVING_BY_RELAXATION;
    default:
        return MOVING_NOT;
    }
}

// Nodes of these lattices coincide: merging leaves 3 throats a grain, and some more on
// sides. (Of 250 grains 4.1, of 2000 3.5.)
static bool is_degenerate(enum method method)
{
    return method == METHOD_CUBIC || method == METHOD_HONEYCOMB;
}

// GRAINS: as many as were read or said; 0: as the parameters will make.
static void estimate(const struct pack_parameters *parameters, double grains)
{
    struct reason reason;
    enum status status = STATUS_OK;
    if (!(grains > 0)) status = expected_count(parameters, &grains, &reason);
    if (status) die(status, "%s", reason.text);
    struct body_size body = body_of_grains(grains);
    if (is_degenerate(parameters->method)) body = body_with_throats(body, 3.5 * grains);
    const struct cost cost = cost_of_packing(grains, moving_of(parameters->method));
    print_estimate(&cost, &body);
}

int main(int argc, char **argv)
{
    struct pack_parameters parameters;
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    json_t *inputs = json_array();
    struct domain domain;
    struct packing packing = {0};
    double unit = 0;
    const char *given = given_input(&invocation, parameters.method);
    if (given && !(invocation.grains > 0))
        packing = make_import(&invocation, &parameters, inputs, &domain, &unit);
    if (invocation.estimates) {
        estimate(&parameters,
                 invocation.grains > 0 ? invocation.grains : packing.n_particle);
        json_decref(inputs);
        packing_free(&packing);
        invocation_free(&invocation);
        return STATUS_OK;
    }

    struct checkpoint checkpoint;
    begin_checkpoint(&checkpoint, &invocation, inputs, parameters.method);
    parameters.dynamics.threads = invocation.threads;
    parameters.dynamics.keeper = &checkpoint.keeper;
    struct reached reached = {.dynamic = false};
    if (parameters.method != METHOD_IMPORT) {
        packing.n_bond = 0; // given grains lose their bonds as they move
        make_packing(&invocation, &parameters, given, &domain, &packing, &reached);
    }
    if (!given && !invocation.quiet) tell_porosity(&parameters, &domain, &packing);
    packing.n_body = domain_bodies(&domain, packing.body);
    take_slab(&parameters, &domain, &packing, invocation.quiet);
    struct contacts contacts = find_contacts(&packing, parameters.touching_gap);
    look_at(&packing, &contacts, &invocation, &parameters, unit);
    make_bonds(&packing, &contacts, &parameters, invocation.quiet);
    if (parameters.extra_layer) make_layer(&domain, parameters.extra_side, &packing);
    write_packing(&packing, &domain, &contacts, &invocation, inputs, &parameters,
                  &reached);

    checkpoint_end(&checkpoint);
    free((void *)contacts.pair);
    packing_free(&packing);
    invocation_free(&invocation);
    return STATUS_OK;
}
