// SPDX-License-Identifier: GPL-3.0-or-later
// What artifacts say of their own limits. Stages tell these as they run; what they
// leave in the summaries is told here again.
//
// Each threshold stands where it is used. A number that an artifact does not have is
// NAN, and no comparison with it holds (but !=, hence isnan): no warning.
//
// What each rests on; a limit behind the sign:
//
//     response   steps_unsettled > 0, and mean.unsettled.cracks of crackstats;
//                gone > 0; snaps > 0; bond_number_body or _grain >= WEIGHT_MATTERS
//                without gravity; weight_cracks > 0; weight_unbalanced_ratio >=
//                tolerance; a packing as its input, without a drying
//     forces     force_scale != 1; interpolation_error > 0.1; field_error > 0.05
//     drying     shut_throats > 0; enclosed_throats > 0; balance_error > 1e-6;
//                residual or liquid_residual > 1e-3; throats that refilled (body.c)
//     packing    max_overlap > 0.1, of the smaller radius
//     check      findings worse than a note, in its own words
//     flow       imbalance > 1e-6, of the flux; closed_throats > 0; pockets > 0
//     motion     largest_overlap > 0.05, of the mean radius; time_step > its limit
//
// Names are those of /summary of each artifact; all are numbers without a unit but the
// two time steps, of which the ratio is told.
#include "facts.h"
#include "geometry/bond_numbers.h"
#include "html.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

// NAN where there is no such artifact, or it does not say.
static double summary_of(const struct run *run, enum kind kind, const char *name)
{
    char whole[80];
    snprintf(whole, sizeof whole, "/summary/%s", name);
    const struct artifact *artifact = run->of[kind];
    return artifact && artifact_has_number(artifact, whole)
               ? artifact_get_number(artifact, whole)
               : NAN;
}

static void warn(FILE *page, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void warn(FILE *page, const char *format, ...)
{
    char text[1000];
    va_list values;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    fputs("<li>", page);
    put_text(page, text);
    fputs("</li>\n", page);
}

// Loads, not grains, are unsettled. What broke under them is known only where
// crackstats was run.
static void warn_of_rest(FILE *page, const struct run *run)
{
    const double unsettled = summary_of(run, RESPONSE, "steps_unsettled");
    const json_t *mean = json_object_get(run->counted, "mean");
    const json_t *broke = json_object_get(json_object_get(mean, "unsettled"), "cracks");
    if (unsettled > 0 && json_is_number(broke))
        warn(page,
             "Under %.0f loads the grains did not come to rest; %.0f bonds broke under "
             "these.",
             unsettled, json_number_value(broke));
    else if (unsettled > 0)
        warn(page, "Under %.0f loads the grains did not come to rest.", unsettled);
    const double gone = summary_of(run, RESPONSE, "gone"),
                 snaps = summary_of(run, RESPONSE, "snaps");
    if (gone > 0)
        warn(page, "%.0f grains detached from the body: nothing held them.", gone);
    if (snaps > 0) warn(page, "The body snapped through or buckled %.0f times.", snaps);
}

// Without a drying the throats of a network are drawn full to the end.
static void warn_of_course(FILE *page, const struct run *run)
{
    if (!counts_steps(run)) return;
    warn(page, "No drying gives times here: a second stands for a step of the load.");
    if (run->network.n_throat)
        warn(page,
             "No drying empties the throats here: they are drawn full to the end.");
}

// As ratio_at_rest of dem-replay: its tolerance, or K's 1e-4 where that is null.
static double ratio_at_rest(const struct run *run)
{
    char *text =
        run->of[RESPONSE] ? artifact_get_text(run->of[RESPONSE], "parameters") : NULL;
    json_t *parameters = text ? json_loads(text, 0, NULL) : NULL;
    const double tolerance =
        json_number_value(json_object_get(parameters, "tolerance"));
    free(text);
    json_decref(parameters);
    return tolerance > 0 ? tolerance : 1e-4;
}

// fmax takes the one that is known. Where gravity is in the run its Bond number is no
// warning.
static void warn_of_weight(FILE *page, const struct run *run)
{
    const double bond = fmax(summary_of(run, RESPONSE, "bond_number_body"),
                             summary_of(run, RESPONSE, "bond_number_grain"));
    if (!(summary_of(run, RESPONSE, "gravity") > 0) && bond >= WEIGHT_MATTERS)
        warn(page, "Gravity is left out, but the weight is %.2g of the suction.", bond);
    const double broke = summary_of(run, RESPONSE, "weight_cracks"),
                 rest = summary_of(run, RESPONSE, "weight_unbalanced_ratio");
    if (broke > 0)
        warn(page,
             "%.0f bonds broke under the weight alone, before drying: they are not "
             "among the cracks.",
             broke);
    if (rest >= ratio_at_rest(run))
        warn(page,
             "Under its weight alone the body did not come to rest before drying: the "
             "unbalanced ratio is %.2g.",
             rest);
}

// A factor of 1 is the physical force.
static void warn_of_forces(FILE *page, const struct run *run)
{
    const double factor = summary_of(run, FORCES, "force_scale"),
                 between = summary_of(run, FORCES, "interpolation_error"),
                 field = summary_of(run, FORCES, "field_error");
    if (!isnan(factor) && factor != 1)
        warn(page, "The forces are %g times the physical ones (force_scale).", factor);
    if (between > 0.1)
        warn(page,
             "Between two loads a force is off a straight line by up to %.2g of the "
             "largest: more force-protocol.steps follow it.",
             between);
    if (field > 0.05)
        warn(page,
             "Between snapshots the suction is off by %.2g of the capillary pressure, "
             "on "
             "average.",
             field);
}

// Residuals are those of vapour and of viscous liquid; the larger counts.
static void warn_of_liquid(FILE *page, const struct run *run,
                           const struct shown_body *body)
{
    const double shut = summary_of(run, DRYING, "shut_throats"),
                 enclosed = summary_of(run, DRYING, "enclosed_throats"),
                 balance = summary_of(run, DRYING, "balance_error"),
                 residual = fmax(summary_of(run, DRYING, "residual"),
                                 summary_of(run, DRYING, "liquid_residual"));
    if (shut > 0) warn(page, "%.0f throats have no clearance and are shut.", shut);
    if (enclosed > 0)
        warn(page, "%.0f throats are cut off from the air and taken as empty.",
             enclosed);
    if (balance > 1e-6)
        warn(page, "%.2g of the liquid is lost in the balance of the drying.", balance);
    if (residual > 1e-3) warn(page, "The drying left a residual of %.2g.", residual);
    if (body->refilled)
        warn(page,
             "Throats filled again %d times; the picture shows each from when it last "
             "emptied.",
             body->refilled);
}

// Findings of `check` that are more than a note.
static void warn_of_grains(FILE *page, const struct run *run)
{
    const double overlap = summary_of(run, PACKING, "max_overlap");
    if (overlap > 0.1)
        warn(page, "Grains overlap by up to %.2g of the smaller radius.", overlap);
    size_t k;
    json_t *finding;
    json_array_foreach(json_object_get(run->checked, "findings"), k, finding)
    {
        const char *severity = json_string_value(json_object_get(finding, "severity"));
        const char *text = json_string_value(json_object_get(finding, "text"));
        if (severity && text && strcmp(severity, "note")) warn(page, "%s", text);
    }
}

// All three are in every flow, so none is asked for first.
static void warn_of_flow(FILE *page, const struct artifact *flow)
{
    if (!flow) return;
    const double imbalance = artifact_get_number(flow, "/summary/imbalance"),
                 closed = artifact_get_number(flow, "/summary/closed_throats"),
                 pockets = artifact_get_number(flow, "/summary/pockets");
    if (imbalance > 1e-6)
        warn(page, "In the worst pore %.2g of the flux is lost or gained.", imbalance);
    if (closed > 0)
        warn(page, "%.0f throats are closed by grains that overlap.", closed);
    if (pockets > 0) warn(page, "%.0f sets of pores have no outlet.", pockets);
}

// The overlap is over the mean radius here, in a packing over the smaller one.
static void warn_of_motion(FILE *page, const struct artifact *motion)
{
    if (!motion) return;
    const double overlap = artifact_get_number(motion, "/summary/largest_overlap"),
                 step = artifact_get_number(motion, "/summary/time_step"),
                 limit = artifact_get_number(motion, "/summary/time_step_limit");
    if (overlap > 0.05)
        warn(page,
             "Grains overlapped by up to %.2g of the mean radius: stiffer contacts "
             "are nearer to solid grains.",
             overlap);
    if (limit > 0 && step > limit)
        warn(page, "The time step is %.2g of the stability limit.", step / limit);
}

// The most important first: whether there is one run or several.
void put_warnings(FILE *page, const struct run *run, const struct shown_body *body)
{
    if (run->of[RESPONSE] && !run->repeated)
        warn(page,
             "This is one run, so the counts have no interval: other seeds of the "
             "throat radii or the packing show how far they scatter.");
    warn_of_rest(page, run);
    warn_of_course(page, run);
    warn_of_weight(page, run);
    warn_of_forces(page, run);
    warn_of_liquid(page, run, body);
    warn_of_grains(page, run);
    warn_of_flow(page, run->flow);
    warn_of_motion(page, run->motion);
}
