// SPDX-License-Identifier: GPL-3.0-or-later
// bridge: the capillary force of a liquid bridge against separation.
//
// Separations are spread evenly between from and to, in parts of the rupture distance
// of the chosen model:
//     separation_k = rupture ((1 - k / (points - 1)) from + k / (points - 1) to).
// The exact model and the table take the rupture distance of the exact solution, the
// approximations their common one [G].
#include "artifacts/artifact.h"
#include "basics/memory.h"
#include "curve.h"
#include "parameters/conditions.h"

#include <math.h>
#include <stdlib.h>

struct bridge_parameters {
    double radius, other_radius, other_contact_angle;
    struct conditions given;
    double volume, from, to;
    int64_t points, profile;
    struct number_list separations;
    int model;
    bool plane;
};

#define AT(field) offsetof(struct bridge_parameters, field)
static const struct parameter table[] = {
    {"model", PARAMETER_CHOICE, "1", "\"exact\"", AT(model),
     .choices = BRIDGE_MODEL_CHOICES,
     .text = "exact: Young and Laplace's equation; table: interpolated from it; the "
             "others are approximations [G 2]"},
    {"radius", PARAMETER_NUMBER, "m", NULL, AT(radius), ABOVE(0),
     .text = "of the first sphere"},
    {"other_radius", PARAMETER_NUMBER, "m", "null", AT(other_radius), ABOVE(0),
     .text = "of the second; null: as the first"},
    {"plane", PARAMETER_BOOLEAN, "1", "false", AT(plane),
     .text = "the second body is a plane"},
    {"volume", PARAMETER_NUMBER, "m3", NULL, AT(volume), ABOVE(0),
     .text = "of the liquid"},
    FLUID_ROWS(AT(given)),
    SURFACE_TENSION_ROW(AT(given)),
    {"contact_angle", PARAMETER_NUMBER, "degree", "0", AT(given.contact_angle),
     BETWEEN(0, 170), .shared = true, .text = "of the liquid on the first body"},
    {"other_contact_angle", PARAMETER_NUMBER, "degree", "null", AT(other_contact_angle),
     BETWEEN(0, 170), .text = "on the second; null: as on the first"},
    {"points", PARAMETER_INTEGER, "1", "101", AT(points), BETWEEN(2, 1000000),
     .text = "separations on the curve, evenly spaced"},
    {"from", PARAMETER_NUMBER, "1", "0", AT(from),
     .text =
         "first separation over the rupture distance of the model; negative: overlap"},
    {"to", PARAMETER_NUMBER, "1", "1", AT(to),
     .text = "last separation over the rupture distance of the model"},
    {"separations", PARAMETER_LIST, "m", "[]", AT(separations),
     .text = "separations to use in place of points, from and to"},
    {"profile", PARAMETER_INTEGER, "1", "0", AT(profile), BETWEEN(0, 100000),
     .text = "points on the meridian of each exact bridge; 0: none"},
    {0}};

static const struct stage stage = {
    .name = "bridge",
    .version = STAGE_VERSION,
    .summary = "bridge -- force against separation of a capillary bridge",
    .writes = "bridge",
    .most_inputs = 0,
    .parameters = table,
    .notes = "Forces that pull are positive. Where a model is used outside its "
             "validity, `flags` says so."};

static struct bridge bridge_of(const struct bridge_parameters *given)
{
    const double degree = M_PI / 180;
    const double other =
        isnan(given->other_radius) ? given->radius : given->other_radius;
    const double angle = isnan(given->other_contact_angle) ? given->given.contact_angle
                                                           : given->other_contact_angle;
    return (struct bridge){
        .radius = {given->radius, given->plane ? INFINITY : other},
        .contact_angle = {given->given.contact_angle * degree, angle * degree},
        .surface_tension = given->given.property[FLUID_SURFACE_TENSION],
        .volume = given->volume};
}

static double rupture_distance(const struct bridge *bridge, enum bridge_model model)
{
    if (model != BRIDGE_EXACT && model != BRIDGE_TABLE)
        return bridge_rupture_distance(bridge);
    struct bridge_state state;
    struct reason reason;
    const enum status status = bridge_solve_rupture(bridge, &state, &reason);
    if (status) die(status, "%s", reason.text);
    return state.separation;
}

// The separations to compute, (COUNT); the caller frees them.
static double *separations_of(const struct bridge_parameters *given, double rupture,
                              int *count)
{
    const struct number_list *list = &given->separations;
    *count = list->count ? list->count : (int)given->points;
    double *separation = NEW_ARRAY(double, *count);
    for (int k = 0; k < *count; k++) {
        const double share = (double)k / (*count - 1);
        separation[k] = list->count
                            ? list->value[k]
                            : rupture * ((1 - share) * given->from + share * given->to);
    }
    return separation;
}

static void complete_liquid(struct conditions *given, bool quiet)
{
    const unsigned needed = 1u << FLUID_SURFACE_TENSION;
    conditions_require(given, needed, "bridge");
    if (!quiet) conditions_note(given, needed);
}

static void check(const struct bridge_parameters *given)
{
    if (given->plane && !isnan(given->other_radius))
        die(STATUS_BAD_DATA, "bridge.other_radius: a plane has none");
    if (given->profile == 1)
        die(STATUS_BAD_DATA, "bridge.profile: must be 0, or from 2 on, got 1");
    if (given->profile && given->model != BRIDGE_EXACT)
        die(STATUS_BAD_DATA, "bridge.profile: only the exact model has one");
}

int main(int argc, char **argv)
{
    struct bridge_parameters parameters = {.given = conditions_unset()};
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    check(&parameters);
    complete_liquid(&parameters.given, invocation.quiet);
    const struct bridge bridge = bridge_of(&parameters);
    struct reason reason;
    if (bridge_check(&bridge, &reason)) die(STATUS_BAD_DATA, "%s", reason.text);
    const double rupture = rupture_distance(&bridge, parameters.model);
    struct curve_request request = {.profile = (int)parameters.profile};
    double *separation = separations_of(&parameters, rupture, &request.count);
    request.separation = separation;

    json_t *report = json_pack(
        "{s:s,s:f,s:f,s:f}", "schema", "craquelure/bridge/1", "effective_radius",
        bridge_effective_radius(&bridge), "dimensionless_volume",
        bridge_dimensionless_volume(&bridge), "rupture_distance", rupture);
    const enum status status =
        put_curve(report, &bridge, parameters.model, &request, &reason);
    if (status) die(status, "%s", reason.text);
    char fluid[300], model[600];
    snprintf(model, sizeof model,
             "axisymmetric liquid bridge at rest, contact lines free to move\n"
             "%s\n"
             "left out: gravity, viscosity, contact-angle hysteresis, roughness, "
             "evaporation\n",
             conditions_describe(&parameters.given, 1u << FLUID_SURFACE_TENSION, fluid,
                                 sizeof fluid));
    finish_json(report, &invocation, json_array(), model);
    free(separation);
    invocation_free(&invocation);
    return STATUS_OK;
}
