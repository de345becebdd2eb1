// SPDX-License-Identifier: GPL-3.0-or-later
// dry: which throat empties when.
#include "artifacts/artifact.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "describe.h"
#include "drying.h"
#include "enclosed.h"
#include "mass_transfer.h"
#include "network/throat_radius.h"
#include "profiles.h"
#include "write_layer.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

enum { RADII_OF_NETWORK }; // the choices that follow are those of enum radius_law
enum { EXCHANGE_LATTICE, EXCHANGE_LUMPED };

struct dry_parameters {
    struct drying_conditions conditions;
    struct number_list snapshots;
    struct air_flow air;
    int liquid, distribution, transfer_law, exchange, feet;
    int enclosed; // throats that others imposed empty have shut in
    int64_t layers, seed;
    unsigned open_walls, imposed_empty;
    struct radius_distribution radii;
};

#define AT(member) offsetof(struct dry_parameters, member)
#define WALLS "-x|+x|-y|+y|-z|+z"

static const struct parameter table[] = {
    {"liquid", PARAMETER_CHOICE, "1", "\"inviscid\"", BOUND_NONE, 0, 0,
     "inviscid|immobile|viscous",
     "liquid of negligible viscosity (very slow drying), immobile (very fast) [K 5.4], "
     "or between the two, as viscosity says [K 3.10]",
     AT(liquid)},
    {"viscosity", PARAMETER_NUMBER, "m2 s-1", "1e-6", BOUND_ABOVE, 0, 0, NULL,
     "kinematic, of viscous liquid [K Table 3.1]", AT(conditions.viscosity)},
    {"surface_tension", PARAMETER_NUMBER, "N m-1", "0.07274", BOUND_ABOVE, 0, 0, NULL,
     "of the liquid; of no effect in inviscid liquid without gravity [K Table 3.1]",
     AT(conditions.surface_tension)},
    {"contact_angle", PARAMETER_NUMBER, "degree", "0", BOUND_BETWEEN, 0, 89.999, NULL,
     "imperfect wetting: the capillary pressure is 2 surface_tension cos(this) / r",
     AT(conditions.contact_angle)},
    {"gravity", PARAMETER_NUMBER, "m s-2", "0", BOUND_MINIMUM, 0, 0, NULL,
     "towards -z: liquid higher up gives way to gas more easily; 0: none",
     AT(conditions.gravity)},
    {"knudsen", PARAMETER_BOOLEAN, "1", "false", BOUND_NONE, 0, 0, NULL,
     "vapour is held up by the walls of narrow throats too: 1/D + 1/D_K, D_K = (2/3) r "
     "sqrt(8 R T / (pi M))",
     AT(conditions.knudsen)},
    {"saturation_step", PARAMETER_NUMBER, "1", "1", BOUND_BETWEEN, 1e-6, 1, NULL,
     "viscous: flow is solved anew when a throat's saturation has changed by this; 1: "
     "when one has emptied or filled",
     AT(conditions.saturation_step)},
    {"open", PARAMETER_CHOICES, "1", "[\"+z\"]", BOUND_NONE, 0, 0, WALLS,
     "the wall that is open to the drying air", AT(open_walls)},
    {"imposed_empty", PARAMETER_CHOICES, "1", "[]", BOUND_NONE, 0, 0,
     WALLS "|outer|inner",
     "walls whose throats hold no liquid and let nothing through [K 5.4]; outer and "
     "inner: those of a cylinder or sphere around the grains, and of what is cut out",
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
    {"boundary_layer.from", PARAMETER_CHOICE, "1", "\"mass_transfer\"", BOUND_NONE, 0,
     0, "mass_transfer|thickness|sherwood|plate|sphere",
     "what its thickness is found from: the parameters so named, or air that flows "
     "along a plate [K 3.6] or around a sphere (Ranz and Marshall)",
     AT(transfer_law)},
    {"boundary_layer.mass_transfer", PARAMETER_NUMBER, "m s-1", "5.1", BOUND_ABOVE, 0,
     0, NULL,
     "mass transfer coefficient: the layer is diffusivity / this thick [K 3.3.5]",
     AT(air.coefficient)},
    {"boundary_layer.thickness", PARAMETER_NUMBER, "m", "5e-6", BOUND_ABOVE, 0, 0, NULL,
     "thickness", AT(air.thickness)},
    {"boundary_layer.sherwood", PARAMETER_NUMBER, "1", "2", BOUND_ABOVE, 0, 0, NULL,
     "Sherwood number: the layer is flow_length / this thick", AT(air.sherwood)},
    {"boundary_layer.flow_length", PARAMETER_NUMBER, "m", "0", BOUND_MINIMUM, 0, 0,
     NULL,
     "sherwood, plate, sphere: length of the body along the flow, or its diameter; 0: "
     "the longer edge of the open side of the box",
     AT(air.length)},
    {"boundary_layer.air_velocity", PARAMETER_NUMBER, "m s-1", "1", BOUND_MINIMUM, 0, 0,
     NULL, "plate, sphere: of the air", AT(air.velocity)},
    {"boundary_layer.kinematic_viscosity", PARAMETER_NUMBER, "m2 s-1", "1.53e-5",
     BOUND_ABOVE, 0, 0, NULL, "plate, sphere: of the air; dry, 293 K, 1 bar",
     AT(air.kinematic_viscosity)},
    {"boundary_layer.exchange", PARAMETER_CHOICE, "1", "\"lattice\"", BOUND_NONE, 0, 0,
     "lattice|lumped",
     "layers of nodes between which vapour also goes sideways, or none: each node of "
     "the surface exchanges with the air by the mass transfer coefficient",
     AT(exchange)},
    {"boundary_layer.columns", PARAMETER_CHOICE, "1", "\"surface\"", BOUND_NONE, 0, 0,
     "surface|auxiliary",
     "nodes it stands on: all of the surface, or those where throats of an auxiliary "
     "layer of grains begin (pack.extra_layer) [K 3.3.5]",
     AT(feet)},
    {"boundary_layer.layers", PARAMETER_INTEGER, "1", "0", BOUND_BETWEEN, 0, 10000,
     NULL, "layers of nodes in it; 0: spaced as throats are long", AT(layers)},
    {"step_interval", PARAMETER_NUMBER, "1", "0", BOUND_BETWEEN, 0, 1, NULL,
     "fall of the saturation from one recorded step to the next, for large networks; "
     "0: "
     "every event is a step; of no effect in viscous liquid",
     AT(conditions.step_interval)},
    {"snapshots", PARAMETER_LIST, "1", "[]", BOUND_BETWEEN, 0, 1, NULL,
     "saturations, falling, at which the state of every throat is written, and the "
     "pressures of viscous liquid",
     AT(snapshots)},
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

static void check_snapshots(const struct number_list *snapshots)
{
    for (int k = 1; k < snapshots->count; k++)
        if (snapshots->value[k] >= snapshots->value[k - 1])
            die(STATUS_BAD_DATA,
                "dry.snapshots: must fall from one to the next, got %g after %g",
                snapshots->value[k], snapshots->value[k - 1]);
}

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

static void put_normalised_rate(struct artifact *artifact,
                                const struct drying_history *history)
{
    double *rate = NEW_ARRAY(double, history->n_step);
    for (int k = 0; k < history->n_step; k++)
        rate[k] = history->rate[k] / history->rate[0];
    artifact_put(artifact, "/history/normalised_rate", rate, history->n_step);
    free(rate);
}

// At the steps of the profiles.
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

static void put_profiles(struct artifact *artifact, const struct network *network,
                         const struct drying_history *history,
                         const struct drying_conditions *conditions)
{
    static const double level[] = {0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1};
    const int n_level = sizeof level / sizeof *level;
    struct profiles profiles =
        profiles_make(network, history, conditions->open_walls,
                      conditions->liquid != LIQUID_IMMOBILE, n_level, level, false);
    put_moments(artifact, "profiles", history, &profiles);
    artifact_put(artifact, "/profiles/depth", profiles.depth, PROFILE_SLICES);
    artifact_put_table(artifact, "/profiles/slice_saturation", profiles.slice, n_level,
                       PROFILE_SLICES);
    artifact_put(artifact, "/profiles/surface_saturation", profiles.surface, n_level);
    artifact_put_table(artifact, "/profiles/clusters", profiles.clusters, n_level,
                       PROFILE_CLASSES);
    profiles_free(&profiles);
}

static void put_snapshots(struct artifact *artifact, const struct network *network,
                          const struct drying_history *history,
                          const struct dry_parameters *parameters)
{
    const struct drying_conditions *conditions = &parameters->conditions;
    struct profiles profiles = profiles_make(
        network, history, conditions->open_walls, conditions->liquid != LIQUID_IMMOBILE,
        parameters->snapshots.count, parameters->snapshots.value, true);
    put_moments(artifact, "snapshots", history, &profiles);
    artifact_put_table(artifact, "/snapshots/throat_saturation",
                       profiles.throat_saturation, profiles.n_level, network->n_throat);
    if (history->pressure)
        artifact_put_table(artifact, "/snapshots/liquid_pressure", history->pressure,
                           profiles.n_level, network->n_node);
    profiles_free(&profiles);
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
    put_normalised_rate(artifact, history);
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
    artifact_put_number(artifact, "/summary/liquid_residual", history->liquid_residual);
}

static void write_drying(const struct network *network,
                         const struct drying_history *history,
                         const struct invocation *invocation,
                         const struct artifact *input,
                         const struct dry_parameters *parameters,
                         const struct mass_transfer *transfer)
{
    const struct drying_conditions *conditions = &parameters->conditions;
    const enum transfer_law law = (enum transfer_law)parameters->transfer_law;
    char model[2000], layer[300], flow[200], liquid[300], switches[500];
    snprintf(model, sizeof model,
             "vapour: quasi-steady diffusion, linear in ln(1 - p_v/p_g) [K 3.9]\n"
             "boundary layer: %s\n"
             "boundary layer: %.17g m thick, from %s\n"
             "liquid: %s\n"
             "throats shut in by those imposed empty, and empty as well: %d\n"
             "%s\n",
             describe_layer(conditions, history, layer),
             history->boundary_layer_thickness, describe_flow(law, transfer, flow),
             describe_liquid(conditions, history, liquid, sizeof liquid),
             parameters->enclosed,
             describe_switches(conditions, switches, sizeof switches));
    struct artifact *artifact = artifact_create("drying");
    artifact_put_network(artifact, network);
    put_history(artifact, history);
    put_summary(artifact, history, parameters->conditions.open_walls);
    put_boundary_layer(artifact, network, &parameters->conditions, history);
    put_profiles(artifact, network, history, conditions);
    if (parameters->snapshots.count > 0)
        put_snapshots(artifact, network, history, parameters);
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

static double longer_open_edge(const struct packing *packing, int wall)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    return fmax(component(edge, (wall + 2) / 2 % 3),
                component(edge, (wall + 4) / 2 % 3));
}

static struct mass_transfer give_mass_transfer(const struct network *network,
                                               struct dry_parameters *parameters,
                                               bool quiet)
{
    struct drying_conditions *conditions = &parameters->conditions;
    struct air_flow *air = &parameters->air;
    struct mass_transfer transfer;
    struct reason reason;
    if (!(air->length > 0) && conditions->open_walls)
        air->length =
            longer_open_edge(&network->packing, __builtin_ctz(conditions->open_walls));
    const enum status status =
        find_mass_transfer((enum transfer_law)parameters->transfer_law, air,
                           conditions->diffusivity, &transfer, &reason);
    if (status) die(status, "dry.%s", reason.text);
    conditions->mass_transfer = transfer.coefficient;
    if (parameters->transfer_law == TRANSFER_PLATE && transfer.sherwood < 1 && !quiet)
        report("boundary_layer: Sh = %.3g: thicker than the plate is long, where "
               "[K 3.6] does not hold (from=sphere does)",
               transfer.sherwood);
    return transfer;
}

int main(int argc, char **argv)
{
    struct dry_parameters parameters = {0};
    struct invocation invocation = stage_begin(&stage, argc, argv, &parameters);
    parameters.conditions.liquid = (enum liquid_limit)parameters.liquid;
    parameters.conditions.open_walls = parameters.open_walls;
    check_snapshots(&parameters.snapshots);
    parameters.conditions.n_snapshot = parameters.snapshots.count;
    parameters.conditions.snapshot = parameters.snapshots.value;
    parameters.conditions.layers = (int)parameters.layers;
    parameters.conditions.feet = (enum boundary_feet)parameters.feet;
    parameters.conditions.lumped = parameters.exchange == EXCHANGE_LUMPED;
    struct artifact *input = artifact_open(invocation.inputs[0], "network");
    struct network network = artifact_get_periodic_network(input);

    const struct mass_transfer transfer =
        give_mass_transfer(&network, &parameters, invocation.quiet);
    give_radii(&network, &parameters);
    impose_empty_throats(&network, parameters.imposed_empty);
    if (parameters.imposed_empty && __builtin_popcount(parameters.open_walls) == 1)
        parameters.enclosed = empty_enclosed_throats(
            &network, __builtin_ctz(parameters.open_walls), parameters.conditions.feet);
    struct drying_history history;
    dry(&network, &parameters, &invocation, input->path, &history);
    write_drying(&network, &history, &invocation, input, &parameters, &transfer);

    drying_history_free(&history);
    network_free(&network);
    artifact_close(input);
    invocation_free(&invocation);
    return STATUS_OK;
}
