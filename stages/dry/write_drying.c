// SPDX-License-Identifier: GPL-3.0-or-later
// The drying artifact: history, events and changes as they were recorded, profiles and
// snapshots made from them, a summary with the balances. Only here do results get
// names. Datasets are those of schemas/drying.json.
//
//     network      as the run used it: radii drawn, throats shut or imposed empty
//     /history     (n_step) time s, saturation, rate kg/s, clusters, normalised_rate
//     /events      (n_event) time s, throat, kind (enum event_kind)
//     /changes     offset (n_step + 1), throat and saturation (offset[n_step])
//     /profiles    (9) time, saturation, surface_saturation; (9, PROFILE_SLICES)
//                  slice_saturation; (9, PROFILE_CLASSES) clusters; depth
//     /snapshots   (n_snapshot) time, saturation; (n_snapshot, n_throat)
//                  throat_saturation; (n_snapshot, n_node) liquid_pressure, Pa
//     /rings, /ring_changes (write_rings.c)
//     /boundary_layer (write_layer.c), /liquid, /gas, /summary
//
// Trap: profiles and snapshots belong to the first recorded step with at most their
// saturation, so /profiles/saturation and /snapshots/saturation say what it was.
#include "write_drying.h"

#include "artifacts/liquid.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "describe.h"
#include "dry/run/profiles.h"
#include "write_layer.h"
#include "write_rings.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// The end of a run within the first period.
static double first_period_end_time(const struct drying_history *history)
{
    const double time = history->first_period_end_time;
    return time > 0 ? time : history->time[history->n_step - 1];
}

// Over the first, so that runs of different sizes can be compared.
static void put_normalised_rate(struct artifact *artifact,
                                const struct drying_history *history)
{
    double *rate = NEW_ARRAY(double, history->n_step);
    for (int k = 0; k < history->n_step; k++)
        rate[k] = history->rate[k] / history->rate[0];
    artifact_put(artifact, "/history/normalised_rate", rate, history->n_step);
    free(rate);
}

// At the steps of the profiles. GROUP without slashes.
static void put_moments(struct artifact *artifact, const char *group,
                        const struct drying_history *history,
                        const struct profiles *profiles)
{
    const int n = profiles->n_level;
    double *time = NEW_ARRAY(double, n), *saturation = NEW_ARRAY(double, n);
    for (int k = 0; k < n; k++) {
        time[k] = history->time[profiles->step[k]];
        saturation[k] = history->saturation[profiles->step[k]];
    }
    char name[64];
    snprintf(name, sizeof name, "/%s/time", group);
    artifact_put(artifact, name, time, n);
    snprintf(name, sizeof name, "/%s/saturation", group);
    artifact_put(artifact, name, saturation, n);
    free(time);
    free(saturation);
}

static enum liquid_paths paths_of(const struct drying_conditions *conditions)
{
    if (conditions->liquid == LIQUID_IMMOBILE) return PATHS_THROATS;
    return conditions->rings == RINGS_JOINED ? PATHS_FILMS : PATHS_PARTED_BY_GAS;
}

// At nine levels, whatever was asked for as snapshots.
static void put_profiles(struct artifact *artifact, const struct network *network,
                         const struct drying_history *history,
                         const struct drying_conditions *conditions)
{
    static const double level[] = {0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1};
    const int n_level = sizeof level / sizeof *level;
    struct profiles profiles =
        profiles_init(network, history, conditions->open_walls, paths_of(conditions),
                      n_level, level, false);
    put_moments(artifact, "profiles", history, &profiles);
    artifact_put(artifact, "/profiles/depth", profiles.depth, PROFILE_SLICES);
    artifact_put_table(artifact, "/profiles/slice_saturation", profiles.slice, n_level,
                       PROFILE_SLICES);
    artifact_put(artifact, "/profiles/surface_saturation", profiles.surface, n_level);
    artifact_put_table(artifact, "/profiles/clusters", profiles.clusters, n_level,
                       PROFILE_CLASSES);
    profiles_free(&profiles);
}

// Throats at the levels that were asked for. Pressures were kept on the way, since they
// do not follow from the history; runs of other liquids have none.
static void put_snapshots(struct artifact *artifact, const struct network *network,
                          const struct drying_history *history,
                          const struct drying_conditions *conditions)
{
    struct profiles profiles =
        profiles_init(network, history, conditions->open_walls, paths_of(conditions),
                      conditions->n_snapshot, conditions->snapshot, true);
    put_moments(artifact, "snapshots", history, &profiles);
    artifact_put_table(artifact, "/snapshots/throat_saturation",
                       profiles.throat_saturation, profiles.n_level, network->n_throat);
    if (history->pressure)
        artifact_put_table(artifact, "/snapshots/liquid_pressure", history->pressure,
                           profiles.n_level, network->n_node);
    profiles_free(&profiles);
}

// Rows of a dataset are counted in int, changes in 64 bits: a run of many small steps
// (step_interval=0) may have more of them than fit.
static void put_history(struct artifact *artifact, const struct drying_history *history)
{
    const int n_step = history->n_step, n_event = history->n_event;
    if (history->change_offset[n_step] > INT_MAX)
        die(STATUS_BAD_DATA,
            "/changes/throat: %lld rows are more than an artifact holds",
            (long long)history->change_offset[n_step]);
    const int n_change = (int)history->change_offset[n_step];
    artifact_put(artifact, "/history/time", history->time, n_step);
    artifact_put(artifact, "/history/saturation", history->saturation, n_step);
    artifact_put(artifact, "/history/rate", history->rate, n_step);
    artifact_put(artifact, "/history/clusters", history->clusters, n_step);
    put_normalised_rate(artifact, history);
    artifact_put(artifact, "/events/time", history->event_time, n_event);
    artifact_put(artifact, "/events/throat", history->event_throat, n_event);
    artifact_put(artifact, "/events/kind", history->event_kind, n_event);
    artifact_put(artifact, "/changes/offset", history->change_offset, n_step + 1);
    artifact_put(artifact, "/changes/throat", history->change_throat, n_change);
    artifact_put(artifact, "/changes/saturation", history->change_saturation, n_change);
}

// What evaporated against what the throats have lost, of the liquid at the start. Two
// independent numbers: the one is summed from rates and times, the other from volumes.
static double balance_error(const struct drying_history *history)
{
    const double left =
        history->saturation[history->n_step - 1] / history->saturation[0];
    const double lost = history->initial_liquid * (1 - left);
    return fabs(history->evaporated - lost) / history->initial_liquid;
}

static void put_summary(struct artifact *artifact, const struct drying_history *history,
                        unsigned open_walls)
{
    artifact_put_number(artifact, "/summary/open_walls", open_walls);
    artifact_put_number(artifact, "/summary/breakthrough_saturation",
                        history->breakthrough_saturation);
    artifact_put_number(artifact, "/summary/first_period_end_saturation",
                        history->first_period_end_saturation);
    artifact_put_number(artifact, "/summary/first_period_end_time",
                        first_period_end_time(history));
    artifact_put_number(artifact, "/summary/liquid_mass", history->initial_liquid);
    artifact_put_number(artifact, "/summary/balance_error", balance_error(history));
    artifact_put_number(artifact, "/summary/residual", history->vapour_residual);
    artifact_put_number(artifact, "/summary/liquid_residual", history->liquid_residual);
}

// For the stages behind, which take surface tension and angle from here.
static void put_fluids(struct artifact *artifact,
                       const struct dry_parameters *parameters)
{
    const struct conditions *given = &parameters->given;
    const struct liquid_properties liquid = liquid_of(given);
    artifact_put_liquid(artifact, &liquid);
    artifact_put_number(artifact, "/gas/pressure", given->gas_pressure);
    artifact_put_number(artifact, "/gas/saturation_pressure",
                        given->property[FLUID_SATURATION_PRESSURE]);
    artifact_put_number(artifact, "/gas/vapour_pressure", given->air_vapour_pressure);
    artifact_put_number(artifact, "/gas/diffusivity",
                        given->property[FLUID_DIFFUSIVITY]);
}

// `model` tells in words what was computed, from the same conditions that the run had.
// The artifact is opened only here, so a run that failed leaves no file.
void write_drying(const struct network *network, const struct drying_history *history,
                  const struct invocation *invocation, const struct artifact *input,
                  const struct dry_parameters *parameters,
                  const struct mass_transfer *transfer)
{
    const struct drying_conditions *conditions = &parameters->conditions;
    const enum transfer_law law = (enum transfer_law)parameters->transfer_law;
    char model[3800], radii[RADII_TEXT], layer[300], flow[200], liquid[300], fluid[900],
        switches[1000];
    snprintf(model, sizeof model,
             "vapour: quasi-steady diffusion, linear in ln(1 - p_v/p_g) [K 3.9]\n"
             "boundary layer: %s\n"
             "boundary layer: %.9g m thick, from %s\n"
             "liquid: %s\n"
             "%s, contact angle %.6g degrees; gas at %.6g Pa, with vapour of %.6g Pa\n"
             "%s"
             "throats without clearance, shut to liquid, vapour and gas: %d\n"
             "throats shut in by these and those imposed empty, and empty as well: %d\n"
             "%s\n",
             describe_layer(conditions, history, layer),
             history->boundary_layer_thickness, describe_flow(law, transfer, flow),
             describe_liquid(conditions, history, liquid, sizeof liquid),
             conditions_describe(&parameters->given, ~0u, fluid, sizeof fluid),
             conditions->contact_angle, conditions->gas_pressure,
             conditions->air_vapour_pressure,
             describe_cut_radii(&parameters->radii, radii), parameters->shut,
             parameters->enclosed,
             describe_switches(conditions, switches, sizeof switches));
    struct artifact *artifact = artifact_create("drying", invocation->output);
    artifact_put_network(artifact, network);
    put_history(artifact, history);
    put_summary(artifact, history, parameters->conditions.open_walls);
    put_fluids(artifact, parameters);
    artifact_put_number(artifact, "/summary/shut_throats", parameters->shut);
    artifact_put_number(artifact, "/summary/enclosed_throats", parameters->enclosed);
    put_boundary_layer(artifact, network, &parameters->conditions, history);
    if (history->rings) put_rings(artifact, history);
    put_profiles(artifact, network, history, conditions);
    if (conditions->n_snapshot > 0)
        put_snapshots(artifact, network, history, conditions);
    artifact_finish(artifact, invocation, one_input(input), model);
}
