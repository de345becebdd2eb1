// SPDX-License-Identifier: GPL-3.0-or-later
// check: are these grains what one thinks?
//
// In this order: grains are read as pack reads them; contacts; bonds, for text those
// that pack would make; measures; judgements, the packing first
// (geometry/packing_check.h), then bonds, grains that touch nothing, defaults of
// another size, weight. The status is 1 if any finding is worse than a note.
//
// Lengths become metres before anything is measured (import.scale, import.diameters),
// as pack does it; an artifact keeps its own bonds. Contacts are pairs within
// touching_gap, of the sum of the radii. Grains of an auxiliary layer, and its part of
// the box, do not count. The material is only for the suggestions and the weight: no
// other finding depends on it. A liquid without a known surface tension at the
// temperature ends the call before grains are read.
//
// Without -o it tells people, with -o it writes schemas/check.json; both by tell.c.
#include "artifacts/artifact.h"
#include "artifacts/read_grains.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "geometry/auxiliary.h"
#include "geometry/fabric.h"
#include "parameters/conditions.h"
#include "rough.h"
#include "rounded.h"
#include "tell.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct check_parameters {
    double touching_gap;
    int64_t frame;
    double import_scale;
    bool import_diameters;
    struct conditions conditions;
    struct material material;
};

#define AT(member) offsetof(struct check_parameters, member)

static const struct parameter table[] = {
    {"touching_gap", PARAMETER_NUMBER, "1", "1e-6", AT(touching_gap), BETWEEN(0, 1),
     .text = "largest gap between touching surfaces, over the sum of the two radii; "
             "this and the following three also as section pack of the scene says",
     .section = "pack"},
    {"frame", PARAMETER_INTEGER, "1", "-1", AT(frame), BETWEEN(-1, 1e12),
     .text = "of a LAMMPS dump, from 0; -1: the last", .section = "pack"},
    {"import.scale", PARAMETER_NUMBER, "m", "1", AT(import_scale), ABOVE(0),
     .text = "metres per unit of length of INPUT (that of pack: of text or a dump)",
     .section = "pack"},
    {"import.diameters", PARAMETER_BOOLEAN, "1", "false", AT(import_diameters),
     .text = "INPUT has diameters in place of radii (that of pack: text or a dump)",
     .section = "pack"},
    {"density", PARAMETER_NUMBER, "kg m-3", "2500", AT(material.density), ABOVE(0),
     .text =
         "of the grains; this and the following parameters are for the suggestions"},
    {"grain_modulus", PARAMETER_NUMBER, "Pa", "6e10", AT(material.grain_modulus),
     ABOVE(0),
     .text = "Young's modulus of the grains, by default glass; counts as at most ten "
             "times bond_modulus (radius_fraction 0.5), so that loads come to rest"},
    {"bond_modulus", PARAMETER_NUMBER, "Pa", "4e8", AT(material.bond_modulus), ABOVE(0),
     .text = "Young's modulus of the bonds"},
    {"radius_fraction", PARAMETER_NUMBER, "1", "0.5", AT(material.radius_fraction),
     BETWEEN(1e-6, 1), .text = "bond radius over the radius of the smaller grain"},
    FLUID_ROWS(AT(conditions)),
    SURFACE_TENSION_ROW(AT(conditions)),
    CONTACT_ANGLE_ROW(AT(conditions), 89),
    {0}};

static const struct stage stage = {
    .name = "check",
    .version = STAGE_VERSION,
    .summary = "check -- are these grains what you think? units, overlaps, box, bonds",
    .reads =
        "packing, or any artifact with one, or text or a dump as pack imports them",
    .writes = "check",
    .most_inputs = 1,
    .parameters = table,
    .notes = "Without -o it prints its findings as text, the worst first; with -o FILE "
             "(or -) it writes JSON. Status 1: something is wrong: pack refuses it, or "
             "it is hardly intended.",
    .tells = true};

// The defaults of dem-replay are those of grains of 500 nm. From a third to three times
// is taken for the same size.
static void judge_defaults(const struct packing_facts *facts, struct findings *findings)
{
    const double usual = 250e-9, ratio = facts->median / usual;
    if (ratio > 1.0 / 3 && ratio < 3) return;
    add_finding(
        findings, FINDING_NOTE, "defaults",
        "dem-replay's defaults are for radii of 250 nm, these are %.3g times as large: "
        "say stiffnesses and strengths (suggested where no more than overlaps is "
        "wrong)",
        ratio);
}

// Loose grains are no error: a loose packing has them. A single grain is not loose.
static void judge_free(const struct packing_facts *facts, struct findings *findings)
{
    if (!facts->free || facts->n < 2) return;
    add_finding(
        findings, FINDING_NOTE, "free",
        "%d of %d grains touch%s neither grain nor wall: dem-replay lets them go, "
        "unless a wider pack.touching_gap bonds them",
        facts->free, facts->n, facts->free == 1 ? "es" : "");
}

// Below this share of the capillary forces weight changes little. The larger of both
// counts: fmax passes over a NAN. The strengths suggested are of the suction alone. Two
// bodies (2000 grains in a cylinder, 3000 of 1:8 in a box) came apart under their
// weight with the body's Bond number times these, and stood with 2 and 4 times as much.
static void judge_weight(const struct bond_numbers *weight, struct findings *findings)
{
    const double most = fmax(weight->grain, weight->body);
    if (!(most >= WEIGHT_MATTERS)) return;
    char strength[120] = "";
    if (4 * weight->body > 1)
        snprintf(strength, sizeof strength,
                 "; bonds that bear it need up to %.2g times the strengths suggested, "
                 "which are for suction alone",
                 4 * weight->body);
    add_finding(findings, FINDING_NOTE, "weight",
                "%s weighs about %.2g of its suction: %sgravity=9.81 in dry adds "
                "weight there and in later programs%s",
                weight->grain < most ? "the body" : "a grain", most,
                weight->grain < 1 ? ""
                                  : "lengths in millimetres (import.scale=1e-3)? if "
                                    "not, ",
                strength);
}

static bool have_other_units(const struct findings *findings)
{
    for (int k = 0; k < findings->count; k++)
        if (!strcmp(findings->item[k].name, "units") ||
            !strcmp(findings->item[k].name, "radii"))
            return true;
    return false;
}

// Without grains there is nothing to judge but that, and in wrong units neither
// defaults nor weight. Of defaults of dem-replay only those that its section REPLAY of
// the scene (NULL: none) leaves. The worst come first whatever the order here
// (add_finding).
static struct findings judge(const struct packing *packing,
                             const struct packing_facts *facts,
                             const struct bond_facts *bonds,
                             const struct bond_numbers *weight, double gap,
                             const json_t *replay)
{
    struct findings findings = {0};
    if (!facts->n)
        add_finding(&findings, FINDING_WRONG, "grains", "there are no grains");
    if (!facts->n) return findings;
    judge_packing(packing, facts, &findings);
    judge_rounding(packing, facts, gap, &findings);
    judge_bonds(packing, facts, bonds, &findings);
    if (!json_object_get(replay, "held") && !json_object_get(replay, "support"))
        judge_support(packing, facts, bonds, &findings);
    judge_ends(packing, facts, bonds, &findings);
    judge_free(facts, &findings);
    if (have_other_units(&findings)) return findings;
    if (!json_object_get(replay, "normal_stiffness")) judge_defaults(facts, &findings);
    judge_weight(weight, &findings);
    return findings;
}

// A dump is "text", too (read_grains.c).
static bool is_text(const json_t *inputs)
{
    const json_t *schema = json_object_get(json_array_get(inputs, 0), "schema");
    return !strcmp(json_string_value(schema), "text");
}

// What pack did to its input, an artifact has behind it: of these only what section
// check or --set says counts.
static void leave_to_pack(const struct invocation *invocation,
                          struct check_parameters *parameters)
{
    json_t *import = json_object_get(invocation->parameters, "import");
    if (json_object_get(invocation->borrowed, "import.scale")) {
        parameters->import_scale = 1;
        json_object_set_new(import, "scale", json_real(1));
    }
    if (json_object_get(invocation->borrowed, "import.diameters")) {
        parameters->import_diameters = false;
        json_object_set_new(import, "diameters", json_false());
    }
}

// Lengths in metres, the liquid's surface tension. UNIT: as facts have it.
static struct packing read_input(const struct invocation *invocation,
                                 struct check_parameters *parameters, double *unit,
                                 json_t *inputs)
{
    const char *path = invocation->inputs[0];
    conditions_require(&parameters->conditions, 1u << FLUID_SURFACE_TENSION, "check");
    parameters->material.surface_tension =
        parameters->conditions.property[FLUID_SURFACE_TENSION];
    parameters->material.contact_angle = parameters->conditions.contact_angle;
    bool has_box;
    struct packing packing = read_grains(path, NULL, parameters->frame, &has_box, unit,
                                         &parameters->import_diameters, inputs);
    if (!is_text(inputs)) leave_to_pack(invocation, parameters);
    if (parameters->import_scale != 1) *unit = 0;
    convert_grains(&packing, parameters->import_scale, parameters->import_diameters,
                   has_box);
    refuse_large_radii(&packing, path);
    return packing;
}

int main(int argc, char **argv)
{
    struct check_parameters parameters = {.conditions = conditions_unset()};
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    json_t *inputs = json_array();
    double unit;
    struct packing packing = read_input(&invocation, &parameters, &unit, inputs);
    const double gap = parameters.touching_gap;
    struct contacts contacts = find_contacts(&packing, gap);
    // Text has no bonds: those that pack would make. Artifacts without bonds are left
    // as they are.
    if (is_text(inputs)) bond_contacts(&packing, &contacts);

    struct packing_facts facts = packing_facts(&packing, &contacts, gap);
    facts.unit = unit;
    struct packing body = without_auxiliary(&packing);
    const struct bond_facts bonds = bond_facts(&body);
    const struct bond_numbers weight =
        expected_bond_numbers(&parameters.material, &body, &facts);
    const struct findings findings =
        judge(&body, &facts, &bonds, &weight, gap,
              json_object_get(invocation.scene, "dem-replay"));
    const struct checked checked = {
        &body, &contacts, &facts, &bonds, &findings, &weight, &parameters.material};
    const int wrong = count_wrong(&findings);
    if (invocation.tells && !invocation.quiet) tell(&checked, wrong);
    if (!invocation.tells)
        finish_json(checked_json(&checked, wrong), &invocation, json_incref(inputs),
                    "grains as spheres, their contacts and bonds\n"
                    "left out: the liquid, forces; of weight whether surface tension "
                    "can bear it\n");

    json_decref(inputs);
    free((void *)contacts.pair);
    packing_free(&body);
    packing_free(&packing);
    invocation_free(&invocation);
    return wrong ? STATUS_NO : STATUS_OK;
}
