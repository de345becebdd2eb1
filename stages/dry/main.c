// SPDX-License-Identifier: GPL-3.0-or-later
// dry: which throat empties when.
#include "artifacts/artifact.h"
#include "basics/status.h"
#include "drying.h"
#include "network/throat_radius.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

enum { RADII_OF_NETWORK }; // the choices that follow are those of enum radius_law

struct dry_parameters {
    struct drying_conditions conditions;
    int liquid, distribution;
    int64_t layers, seed;
    unsigned open_walls, imposed_empty;
    struct radius_distribution radii;
};

#define AT(member) offsetof(struct dry_parameters, member)
#define WALLS "-x|+x|-y|+y|-z|+z"

static const struct parameter table[] = {
    {"liquid", PARAMETER_CHOICE, "1", "\"inviscid\"", BOUND_NONE, 0, 0,
     "inviscid|immobile",
     "liquid of negligible viscosity (very slow drying), or immobile (very fast) [K "
     "5.4]",
     AT(liquid)},
    {"open", PARAMETER_CHOICES, "1", "[\"+z\"]", BOUND_NONE, 0, 0, WALLS,
     "the wall that is open to the drying air", AT(open_walls)},
    {"imposed_empty", PARAMETER_CHOICES, "1", "[]", BOUND_NONE, 0, 0, WALLS,
     "walls whose throats hold no liquid and let nothing through [K 5.4]",
     AT(imposed_empty)},
    {"throat_radius.distribution", PARAMETER_CHOICE, "1", "\"network\"", BOUND_NONE, 0,
     0, "network|normal|lognormal|uniform|two_mode",
     "throat radii: as in the network, or drawn [K 2.2, 3.11]; drawn ones make the "
     "throats cylinders",
     AT(distribution)},
    {"throat_radius.mean", PARAMETER_NUMBER, "m", "103e-9", BOUND_ABOVE, 0, 0, NULL,
     "mean of drawn radii; two_mode: of the first mode", AT(radii.mean)},
    {"throat_radius.standard_deviation", PARAMETER_NUMBER, "m", "1e-9", BOUND_MINIMUM,
     0, 0, NULL, "their standard deviation", AT(radii.deviation)},
    {"throat_radius.second_mean", PARAMETER_NUMBER, "m", "40e-9", BOUND_ABOVE, 0, 0,
     NULL, "two_mode: mean of the second mode", AT(radii.second_mean)},
    {"throat_radius.second_standard_deviation", PARAMETER_NUMBER, "m", "2e-9",
     BOUND_MINIMUM, 0, 0, NULL, "its standard deviation", AT(radii.second_deviation)},
    {"throat_radius.second_share", PARAMETER_NUMBER, "1", "0.5", BOUND_BETWEEN, 0, 1,
     NULL, "share of the throats in it", AT(radii.second_share)},
    {"throat_radius.correlation_length", PARAMETER_NUMBER, "m", "0", BOUND_MINIMUM, 0,
     0, NULL,
     "drawn radii are alike within this distance, their distribution the same; 0: "
     "independent",
     AT(radii.correlation_length)},
    {"throat_radius.seed", PARAMETER_INTEGER, "1", "1", BOUND_BETWEEN, 0, 4294967295.0,
     NULL, "seed of drawn radii", AT(seed)},
    {"temperature", PARAMETER_NUMBER, "K", "293.15", BOUND_ABOVE, 0, 0, NULL,
     "temperature [K Table 3.1]", AT(conditions.temperature)},
    {"gas_pressure", PARAMETER_NUMBER, "Pa", "1e5", BOUND_ABOVE, 0, 0, NULL,
     "pressure of the gas", AT(conditions.gas_pressure)},
    {"saturation_pressure", PARAMETER_NUMBER, "Pa", "2339", BOUND_ABOVE, 0, 0, NULL,
     "equilibrium vapour pressure", AT(conditions.saturation_pressure)},
    {"air_vapour_pressure", PARAMETER_NUMBER, "Pa", "0", BOUND_MINIMUM, 0, 0, NULL,
     "vapour pressure in the drying air", AT(conditions.air_vapour_pressure)},
    {"diffusivity", PARAMETER_NUMBER, "m2 s-1", "2.5685e-5", BOUND_ABOVE, 0, 0, NULL,
     "of vapour in the gas", AT(conditions.diffusivity)},
    {"molar_mass", PARAMETER_NUMBER, "kg mol-1", "0.01802", BOUND_ABOVE, 0, 0, NULL,
     "of the liquid", AT(conditions.molar_mass)},
    {"liquid_density", PARAMETER_NUMBER, "kg m-3", "998.2", BOUND_ABOVE, 0, 0, NULL,
     "of the liquid", AT(conditions.liquid_density)},
    {"boundary_layer.mass_transfer", PARAMETER_NUMBER, "m s-1", "5.1", BOUND_ABOVE, 0,
     0, NULL,
     "mass transfer coefficient: the layer is diffusivity / this thick [K 3.3.5]",
     AT(conditions.mass_transfer)},
    {"boundary_layer.layers", PARAMETER_INTEGER, "1", "0", BOUND_BETWEEN, 0, 10000,
     NULL, "layers of nodes in it; 0: spaced as throats are long", AT(layers)},
    {"first_period_rate", PARAMETER_NUMBER, "1", "0.9", BOUND_BETWEEN, 0.01, 0.999,
     NULL,
     "the first drying period ends when the rate falls below this share of its start",
     AT(conditions.first_period_rate_fraction)},
    {0}};

static const struct stage stage = {
    .name = "dry",
    .version = STAGE_VERSION,
    .summary = "dry -- dry a pore network throat by throat [K 3.4]",
    .reads = "network",
    .writes = "drying",
    .most_inputs = 1,
    .parameters = table};

static void show(void *bar, double fraction)
{
    progress_update(bar, fraction);
}

static void dry(const struct network *network, const struct dry_parameters *parameters,
                const struct invocation *invocation, const char *path,
                struct drying_history *history)
{
    struct progress bar = progress_begin(invocation->progress, invocation->quiet);
    struct reason reason;
    const enum status status =
        dry_network(network, &parameters->conditions,
                    &(struct drying_progress){show, &bar}, history, &reason);
    progress_end(&bar);
    if (status) die(status, "%s: %s", input_name(path), reason.text);
}

static double first_period_end_time(const struct drying_history *history)
{
    for (int k = 0; k < history->n_step; k++)
        if (history->saturation[k] <= history->first_period_end_saturation)
            return history->time[k];
    return history->time[history->n_step - 1];
}

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
    artifact_put(artifact, "/events/time", history->event_time, n_event);
    artifact_put(artifact, "/events/throat", history->event_throat, n_event);
    artifact_put(artifact, "/events/kind", history->event_kind, n_event);
    artifact_put(artifact, "/changes/offset", history->change_offset, n_step + 1);
    artifact_put(artifact, "/changes/throat", history->change_throat, n_change);
    artifact_put(artifact, "/changes/saturation", history->change_saturation, n_change);
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
    artifact_put_number(artifact, "/summary/balance_error",
                        fabs(history->evaporated - history->initial_liquid) /
                            history->initial_liquid);
    artifact_put_number(artifact, "/summary/residual", history->vapour_residual);
}

static void write_drying(const struct network *network,
                         const struct drying_history *history,
                         const struct invocation *invocation,
                         const struct artifact *input,
                         const struct dry_parameters *parameters)
{
    char model[900];
    snprintf(model, sizeof model,
             "vapour: quasi-steady diffusion, linear in ln(1 - p_v/p_g) [K 3.9]\n"
             "boundary layer: %d layers over %.17g m, lateral diffusion included\n"
             "liquid: %s\n"
             "left out: viscosity between the two limits, gravity, films, Kelvin and "
             "Knudsen effects, temperature\n",
             history->boundary_layers, history->boundary_layer_thickness,
             parameters->conditions.liquid == LIQUID_INVISCID
                 ? "negligible viscosity, invasion percolation cluster by cluster"
                 : "immobile, each throat dries by itself");
    struct artifact *artifact = artifact_create("drying");
    artifact_put_network(artifact, network);
    put_history(artifact, history);
    put_summary(artifact, history, parameters->conditions.open_walls);
    artifact_finish(artifact, invocation, one_input(input), model);
}

static void give_radii(struct network *network, const struct dry_parameters *parameters)
{
    if (parameters->distribution == RADII_OF_NETWORK) return;
    struct radius_distribution distribution = parameters->radii;
    distribution.law = (enum radius_law)(parameters->distribution - 1);
    distribution.seed = (unsigned long)parameters->seed;
    struct reason reason;
    const enum status status = draw_radii(network, &distribution, &reason);
    if (status) die(status, "dry.%s", reason.text);
}

int main(int argc, char **argv)
{
    struct dry_parameters parameters = {0};
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    parameters.conditions.liquid = (enum liquid_limit)parameters.liquid;
    parameters.conditions.open_walls = parameters.open_walls;
    parameters.conditions.layers = (int)parameters.layers;
    struct artifact *input = artifact_open(invocation.inputs[0], "network");
    struct network network = artifact_get_periodic_network(input);

    give_radii(&network, &parameters);
    impose_empty_throats(&network, parameters.imposed_empty);
    struct drying_history history;
    dry(&network, &parameters, &invocation, input->path, &history);
    write_drying(&network, &history, &invocation, input, &parameters);

    drying_history_free(&history);
    network_free(&network);
    artifact_close(input);
    invocation_free(&invocation);
    return STATUS_OK;
}
