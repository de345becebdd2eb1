// SPDX-License-Identifier: GPL-3.0-or-later
// rings: the liquid that stays in a packing as rings around contacts and in narrow gaps
// when throats have emptied, over suction, and the stress by which it holds the body:
//     content    = volume of rings / volume of grains,
//     saturation = volume of rings / void volume of the box,
//     stress     = trace of pull / 3 / box volume        (retained.h);
// where the grains lie within a round body, its volume stands for that of the box.
// Suctions are the user's, or evenly spread on a logarithmic axis, in units of surface
// tension over the mean radius.
#include "artifacts/artifact.h"
#include "basics/memory.h"
#include "geometry/neighbours.h"
#include "geometry/porosity.h"
#include "parameters/conditions.h"
#include "repeated.h"
#include "retained.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

struct rings_parameters {
    struct conditions given;
    double from, to;
    int64_t points;
    struct number_list suctions;
};

#define AT(field) offsetof(struct rings_parameters, field)
static const struct parameter table[] = {
    {"from", PARAMETER_NUMBER, "1", "5", AT(from), ABOVE(0),
     .text = "first suction, over surface tension / mean radius; at 4.1 rings of equal "
             "grains that touch and wet perfectly meet"},
    {"to", PARAMETER_NUMBER, "1", "500", AT(to), ABOVE(0), .text = "last suction"},
    {"points", PARAMETER_INTEGER, "1", "21", AT(points), BETWEEN(2, 10000),
     .text = "suctions from the first to the last, by equal ratios"},
    {"suctions", PARAMETER_LIST, "Pa", "[]", AT(suctions),
     .text = "suctions to use in place of from, to and points; they must rise"},
    FLUID_ROWS(AT(given)),
    SURFACE_TENSION_ROW(AT(given)),
    {"contact_angle", PARAMETER_NUMBER, "degree", "0", AT(given.contact_angle),
     BETWEEN(0, 89.999), .shared = true, .text = "of the liquid on the grains"},
    {0}};

static const struct stage stage = {
    .name = "rings",
    .version = STAGE_VERSION,
    .summary = "rings -- liquid that stays around contacts, and its pull, over suction",
    .reads = "packing",
    .writes = "rings",
    .most_inputs = 1,
    .parameters = table,
    .notes = "Each ring is the exact bridge between its two grains (docs/bridges.md). "
             "Where `meeting` is above 0 some rings meet on a grain: from there on "
             "throats fill, and rings hold less than all of the liquid."};

// The suctions in Pa, (*COUNT); the caller frees them.
static double *suctions_of(const struct rings_parameters *given, double unit,
                           int *count)
{
    const struct number_list *list = &given->suctions;
    *count = list->count ? list->count : (int)given->points;
    double *suction = NEW_ARRAY(double, *count);
    for (int k = 0; k < *count; k++)
        suction[k] = list->count ? list->value[k]
                                 : unit * given->from *
                                       pow(given->to / given->from,
                                           (double)k / (double)(given->points - 1));
    for (int k = 0; k < *count; k++)
        if (!(suction[k] > 0) || (k && !(suction[k] > suction[k - 1])))
            die(STATUS_BAD_DATA,
                list->count ? "rings.suctions: must be above 0 and rise, got %g Pa"
                            : "rings.to: must be above rings.from (suction %g Pa)",
                suction[k]);
    return suction;
}

// The packing, repeated where grains may meet by several images: the largest distance
// of two centres with a ring between them is two largest radii and the gap. That is at
// most 2 tension / suction wide, and below the largest radius even at no suction: a
// catenoid spans 0.4 of it between equal spheres, less between unequal ones.
static struct packing wide_packing(const struct packing *packing, double suction,
                                   double tension, const char *name, int *copies)
{
    double largest = 0;
    for (int i = 0; i < packing->n_particle; i++)
        largest = fmax(largest, packing->radius[i]);
    const struct vector edge = subtract(packing->upper, packing->lower);
    for (int axis = 0; axis < 3; axis++)
        if (packing->periodic[axis] && component(edge, axis) < largest)
            die(STATUS_BAD_DATA,
                "%s: /domain/upper: a box that repeats must be wider than the largest "
                "radius, %g m, is %g m wide",
                name, largest, component(edge, axis));
    const double gap = fmin(2 * tension / suction, largest);
    return repeated_packing(packing, 2 * largest + gap, copies);
}

// All grains, and what of them is WITHIN the box (parts may stick out), m3.
static double volume_of_grains(const struct packing *packing, double *within)
{
    struct contacts contacts;
    int32_t(*pair)[2] = neighbour_pairs(packing, 0, &contacts.count);
    contacts.pair = (const int32_t(*)[2])pair;
    const double volume = solid_volume(packing, &contacts);
    const struct window box = {packing->lower, packing->upper};
    double porosity;
    slice_porosity(packing, &contacts, &box, 1, &porosity);
    *within = (1 - porosity) * packing_domain_volume(packing);
    free(pair);
    return volume;
}

static void append(json_t *report, const char *name, json_t *value)
{
    json_array_append_new(json_object_get(report, name), value);
}

static json_t *tensor(const double of[3][3], double factor)
{
    json_t *rows = json_array();
    for (int a = 0; a < 3; a++)
        json_array_append_new(rows, json_pack("[f,f,f]", factor * of[a][0],
                                              factor * of[a][1], factor * of[a][2]));
    return rows;
}

// BOX, SOLID and EMPTY: volumes of the domain, of the grains, and of the void, m3. What
// IS retained is of so many COPIES of them.
static void append_row(json_t *report, double box, double solid, double empty,
                       double suction, const struct retained *is, int copies)
{
    const double trace = is->pull[0][0] + is->pull[1][1] + is->pull[2][2];
    const double volume = is->volume / copies;
    append(report, "suction", json_real(suction));
    append(report, "rings", json_integer(lround(1.0 * is->rings / copies)));
    append(report, "meeting", json_integer(lround(1.0 * is->meeting / copies)));
    append(report, "volume", json_real(volume));
    append(report, "content", json_real(volume / solid));
    append(report, "saturation", json_real(volume / empty));
    append(report, "stress", json_real(trace / 3 / box / copies));
    append(report, "stress_tensor", tensor(is->pull, 1 / (box * copies)));
}

// Between a grain and one that lies inside it there is no surface to hold a ring. Of
// copies, the grain of PACKING, which stand one behind the other.
static void refuse_inner_grains(const struct packing *packing,
                                const struct packing *wide,
                                const struct ring_sites *sites, const char *name)
{
    const int n = packing->n_particle;
    for (int k = 0; k < sites->count; k++) {
        const int32_t *grain = sites->grain[k];
        const double a = wide->radius[grain[0]], b = wide->radius[grain[1]];
        if (sites->separation[k] > -2 * fmin(a, b)) continue;
        const int inner = grain[a < b ? 0 : 1] % n, outer = grain[a < b ? 1 : 0] % n;
        die(STATUS_BAD_DATA,
            "%s: /particles: grain %d lies inside grain %d, so that no ring is between "
            "them: leave one of the two out (`check` finds overlaps)",
            name, inner, outer);
    }
}

static json_t *report_of(const struct packing *packing, const struct liquid *liquid,
                         const struct rings_parameters *given, const char *name)
{
    const double radius = mean_radius(packing), unit = liquid->tension / radius;
    int count, copies;
    double *suction = suctions_of(given, unit, &count);
    struct packing wide =
        wide_packing(packing, suction[0], liquid->tension, name, &copies);
    double within;
    const double box = packing_domain_volume(packing),
                 solid = volume_of_grains(&wide, &within) / copies,
                 empty = box - within / copies;
    struct ring_sites sites = sites_of(&wide, suction[0], liquid->tension);
    refuse_inner_grains(packing, &wide, &sites, name);
    json_t *report = json_pack(
        "{s:s,s:i,s:f,s:f,s:f,s:i,s:[],s:[],s:[],s:[],s:[],s:[],s:[],s:[]}", "schema",
        "craquelure/rings/1", "grains", packing->n_particle, "mean_radius", radius,
        "box_volume", box, "solid_volume", solid, "contacts",
        (int)lround(1.0 * sites.contacts / copies), "suction", "rings", "meeting",
        "volume", "content", "saturation", "stress", "stress_tensor");
    for (int k = 0; k < count; k++) {
        struct retained retained;
        struct reason reason;
        const enum status status =
            retain(&wide, &sites, liquid, suction[k], &retained, &reason);
        if (status) die(status, "%s", reason.text);
        append_row(report, box, solid, empty, suction[k], &retained, copies);
    }
    sites_free(&sites);
    packing_free(&wide);
    free(suction);
    return report;
}

static void complete_liquid(struct conditions *given, bool quiet)
{
    const unsigned needed = 1u << FLUID_SURFACE_TENSION;
    conditions_require(given, needed, "rings");
    if (!quiet) conditions_note(given, needed);
}

int main(int argc, char **argv)
{
    struct rings_parameters parameters = {.given = conditions_unset()};
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    complete_liquid(&parameters.given, invocation.quiet);
    omp_set_num_threads(invocation.threads);
    struct artifact *input = artifact_open(invocation.inputs[0], "packing");
    struct packing packing = artifact_get_solid_packing(input, "rings");
    if (packing.n_particle == 0)
        die(STATUS_BAD_DATA, "%s: must hold grains", input_name(input->path));
    const struct liquid liquid = {.tension =
                                      parameters.given.property[FLUID_SURFACE_TENSION],
                                  .angle = parameters.given.contact_angle * M_PI / 180};
    json_t *report = report_of(&packing, &liquid, &parameters, input_name(input->path));
    char fluid[300], model[800];
    snprintf(model, sizeof model,
             "liquid rings between two grains each, at one suction, joined to other "
             "liquid\n"
             "%s\n"
             "left out: rings at walls, rings that have merged, gravity, contact-angle "
             "hysteresis, roughness\n",
             conditions_describe(&parameters.given, 1u << FLUID_SURFACE_TENSION, fluid,
                                 sizeof fluid));
    finish_json(report, &invocation, one_input(input), model);
    artifact_close(input);
    packing_free(&packing);
    invocation_free(&invocation);
    return STATUS_OK;
}
