// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of dry as one table. Defaults that are numbers stand in it; null means
// that the default depends on the network, the liquid or another parameter, and
// complete_conditions finds it. Rows of liquids, gas and drawn radii are shared with
// other stages (parameters/conditions.h, network/drawn_radii.h).
//
// Rows in this order: the liquid and its forces; walls; radii to draw; properties of
// liquid and gas; the boundary layer; where the run begins, ends and what it records.
//
// Trap: a choice is stored as its place in .choices and cast to an enum later. So the
// order of liquid must be that of enum liquid_limit, of boundary_layer.from that of
// enum transfer_law, of boundary_layer.columns that of enum boundary_feet. A set of
// walls is stored as bits in the order of .choices, which are the bits of enum wall;
// outer and inner are WALL_OUTER and WALL_INNER.
#include "parameters.h"

#include "basics/memory.h"
#include "conditions.h"
#include "costs/costs.h"

#include <math.h>
#include <stddef.h>

// Up to this size of network step_interval: null means every event, above it steps of
// COARSE_STEPS.
enum { MAX_THROATS_BY_EVENTS = 30000 };
static const double COARSE_STEPS = 1e-3;

// The same for films.step.
enum { MAX_THROATS_BY_FILM_FLOWS = 3000 };
static const double FILM_STEPS = 2e-2;

// And for flow_step.
enum { MAX_THROATS_BY_FLOWS = 20000 };
static const double FLOW_STEPS = 1e-2;

#define AT(member) offsetof(struct dry_parameters, member)
#define GIVEN AT(given)
#define WALLS "-x|+x|-y|+y|-z|+z"

const struct parameter dry_table[] = {
    {"liquid", PARAMETER_CHOICE, "1", "\"inviscid\"", AT(liquid),
     .choices = "inviscid|immobile|viscous",
     .text = "liquid of negligible viscosity (very slow drying), immobile (very fast) "
             "[K 5.4], or between the two, as viscosity says [K 3.10]"},
    VISCOSITY_ROW(GIVEN),
    SURFACE_TENSION_ROW(GIVEN),
    CONTACT_ANGLE_ROW(GIVEN, 89.999),
    {"gravity", PARAMETER_NUMBER, "m s-2", "0", AT(conditions.gravity), AT_LEAST(0),
     .text = "towards -z: liquid higher up gives way to gas more easily; 0: none"},
    {"knudsen", PARAMETER_BOOLEAN, "1", "false", AT(conditions.knudsen),
     .text = "walls of narrow throats slow vapour too: 1/D + 1/D_K, D_K = (2/3) r "
             "sqrt(8 R T / (pi M))"},
    {"kelvin", PARAMETER_BOOLEAN, "1", "false", AT(conditions.kelvin),
     .text =
         "curved menisci have a lower vapour pressure, p_sat exp(-p_c M / (rho R T)), "
         "p_c = 2 surface_tension cos(contact_angle) / r of each throat (immobile), of "
         "a cluster's widest meniscus (inviscid), or as the flow makes it (viscous); "
         "vapour also goes from wide throats to narrow ones, and may condense there"},
    {"rings", PARAMETER_CHOICE, "1", "\"none\"", AT(rings),
     .choices = "none|isolated|joined|films",
     .text =
         "liquid that throats leave around contacts and in gaps when they empty: "
         "none; rings of the suction at which gas enters the throat, which dry when "
         "their node has no other liquid (inviscid, immobile); such rings that "
         "films without resistance feed as long as any throat holds liquid "
         "(inviscid); or films in the corners of throats, with the resistance that "
         "films.* and viscosity give (inviscid)"},
    {"films.corners", PARAMETER_NUMBER, "1", "3", AT(conditions.films.corners),
     BETWEEN(1, 12), .text = "corners of a throat, all alike, that hold a film"},
    {"films.half_angle", PARAMETER_NUMBER, "degree", "30",
     AT(conditions.films.half_angle), BETWEEN(1, 89),
     .text = "half of the angle between the walls of a corner: 30 and three corners "
             "are a triangle, 45 and four a square; no films where this and "
             "contact_angle make 90 or more"},
    {"films.conductance", PARAMETER_NUMBER, "1", "1", AT(conditions.films.conductance),
     BETWEEN(0, 1e12),
     .text = "factor of what films conduct; 0: none, as rings=isolated"},
    {"films.step", PARAMETER_NUMBER, "1", "null", AT(conditions.films.step),
     BETWEEN(0, 1),
     .text = "fall of the saturation after which the flow in films is found again; 0: "
             "at each event; null: 0 up to 3000 throats, 0.02 in larger networks"},
    {"saturation_step", PARAMETER_NUMBER, "1", "1", AT(conditions.saturation_step),
     BETWEEN(1e-6, 1),
     .text = "viscous: the flow is computed again when the saturation of a throat has "
             "changed by this; 1: when a throat has emptied or filled"},
    {"flow_step", PARAMETER_NUMBER, "1", "null", AT(conditions.flow_step),
     BETWEEN(0, 0.5),
     .text = "viscous: share of its liquid that a cluster may lose until its flow is "
             "found again; 0: found at each event; null: 0 up to 20,000 throats, 0.01 "
             "in larger networks, but 0 with kelvin or saturation_step"},
    {"open", PARAMETER_CHOICES, "1", "[\"+z\"]", AT(open_walls), .choices = WALLS,
     .text = "walls open to the drying air, any set; the others let nothing through"},
    {"imposed_empty", PARAMETER_CHOICES, "1", "[]", AT(imposed_empty),
     .choices = WALLS "|outer|inner",
     .text = "walls whose throats hold no liquid and let nothing through [K 5.4]; "
             "outer and inner: those of a cylinder or sphere around the grains, and of "
             "what is cut out"},
    DRAWN_RADII_ROWS(AT(radii)),
    FLUID_ROWS(GIVEN),
    VAPOUR_ROWS(GIVEN),
    LIQUID_DENSITY_ROW(GIVEN),
    {"boundary_layer.from", PARAMETER_CHOICE, "1", "\"mass_transfer\"",
     AT(transfer_law), .choices = "mass_transfer|thickness|sherwood|plate|sphere",
     .text = "what its thickness follows from: the parameter of this name, or air that "
             "flows along a plate [K 3.6] or around a sphere (Ranz and Marshall)"},
    {"boundary_layer.mass_transfer", PARAMETER_NUMBER, "m s-1", "null",
     AT(air.coefficient), ABOVE(0),
     .text =
         "mass transfer coefficient: the layer is diffusivity / this thick [K 3.3.5]; "
         "null: it is as thick as boundary_layer.thickness says"},
    {"boundary_layer.thickness", PARAMETER_NUMBER, "m", "5e-6", AT(air.thickness),
     ABOVE(0), .text = "thickness of the layer"},
    {"boundary_layer.sherwood", PARAMETER_NUMBER, "1", "2", AT(air.sherwood), ABOVE(0),
     .text = "Sherwood number: the layer is flow_length / this thick"},
    {"boundary_layer.flow_length", PARAMETER_NUMBER, "m", "0", AT(air.length),
     AT_LEAST(0),
     .text = "sherwood, plate, sphere: length of the body along the flow, or its "
             "diameter; 0: the longer edge of the open side of the box"},
    {"boundary_layer.air_velocity", PARAMETER_NUMBER, "m s-1", "1", AT(air.velocity),
     AT_LEAST(0), .text = "plate, sphere: of the air"},
    {"boundary_layer.kinematic_viscosity", PARAMETER_NUMBER, "m2 s-1", "null",
     AT(air.kinematic_viscosity), ABOVE(0),
     .text = "plate, sphere: of the air; null: of dry air at the temperature and "
             "pressure"},
    {"boundary_layer.exchange", PARAMETER_CHOICE, "1", "\"lattice\"", AT(exchange),
     .choices = "lattice|lumped",
     .text =
         "layers of nodes between which vapour also goes sideways, or none: each node "
         "of the surface exchanges with the air by the mass transfer coefficient"},
    {"boundary_layer.columns", PARAMETER_CHOICE, "1", "\"surface\"", AT(feet),
     .choices = "surface|auxiliary",
     .text = "nodes that carry the columns of the layer: all of the surface, or those "
             "where throats of an auxiliary layer of grains begin (pack.extra_layer) "
             "[K 3.3.5]"},
    {"boundary_layer.layers", PARAMETER_INTEGER, "1", "0", AT(layers),
     BETWEEN(0, 10000),
     .text = "layers of nodes in it; 0: as far apart as throats are long"},
    {"start_saturation", PARAMETER_NUMBER, "1", "1", AT(conditions.start_saturation),
     BETWEEN(1e-9, 1),
     .text = "liquid at the start, over the throats' volume: the rest after gas has "
             "entered through the open walls, always into the easiest throat; if INPUT "
             "is a drying, its state at that saturation; no effect if INPUT says how "
             "full its throats are"},
    {"start_trapping", PARAMETER_BOOLEAN, "1", "false", AT(conditions.start_trapping),
     .text =
         "while gas enters for start_saturation, liquid leaves only through the closed "
         "walls opposite the open ones; liquid that gas has cut off from them stays"},
    {"stop_saturation", PARAMETER_NUMBER, "1", "0", AT(conditions.stop_saturation),
     BETWEEN(0, 0.999999), .text = "liquid at the end, of the throats' volume; 0: dry"},
    {"vapour_tolerance", PARAMETER_NUMBER, "1", "0", AT(conditions.vapour_tolerance),
     BETWEEN(0, 0.5),
     .text =
         "largest sum of the errors of evaporation, over the rate, 1e-6 or more: links "
         "between the nodes of large fronts are kept to seven digits; 0: exact"},
    {"vapour_step", PARAMETER_NUMBER, "1", "null", AT(conditions.vapour_step),
     BETWEEN(0, 0.5),
     .text =
         "largest sum of the errors of evaporation, over the rate, until the vapour "
         "is found again in all of the gas (until then it changes only near nodes "
         "that dry); 0: found at each event; null: 0.3, 0.15 with rings=films, "
         "above 1000 nodes on the open walls where this is estimated to take less "
         "time; else 0, as with kelvin, flow_step=0 in viscous liquid, or a "
         "vapour_tolerance"},
    {"step_interval", PARAMETER_NUMBER, "1", "null", AT(conditions.step_interval),
     BETWEEN(0, 1),
     .text = "fall of the saturation from one recorded step to the next; 0: every "
             "event is a step (up to 100000 throats); null: 0 up to 30000 throats, "
             "0.001 in larger networks"},
    {"snapshots", PARAMETER_LIST, "1", "[]", AT(snapshots), BETWEEN(0, 1),
     .text = "saturations, falling, at which the state of every throat is written, and "
             "the pressures of viscous liquid"},
    {"snapshot_interval", PARAMETER_NUMBER, "1", "0", AT(snapshot_interval),
     BETWEEN(0, 1),
     .text = "instead of snapshots: fall of the saturation between two, from 1 on, at "
             "least 1e-4; 0: as listed"},
    {"first_period_rate", PARAMETER_NUMBER, "1", "0.9",
     AT(conditions.first_period_rate_fraction), BETWEEN(0.01, 0.999),
     .text = "the first drying period ends when the rate falls below this share of its "
             "start"},
    {0}};

// Saturations of 1 and less, INTERVAL apart, above 0.
static double *even_snapshots(double interval, int *count)
{
    double *snapshot = NEW_ARRAY(double, 1 / interval + 2);
    for (*count = 0; *count * interval < 1; (*count)++)
        snapshot[*count] = 1 - *count * interval;
    return snapshot;
}

// The fluid properties (bits) that drying with these parameters needs.
static unsigned needed_properties(const struct dry_parameters *parameters)
{
    const struct drying_conditions *conditions = &parameters->conditions;
    const bool flows = parameters->liquid == LIQUID_VISCOUS;
    unsigned needed = 1u << FLUID_SATURATION_PRESSURE | 1u << FLUID_DIFFUSIVITY |
                      1u << FLUID_MOLAR_MASS | 1u << FLUID_DENSITY;
    if (flows || parameters->rings == RINGS_FILMS) needed |= 1u << FLUID_VISCOSITY;
    if (flows || conditions->gravity > 0 || conditions->kelvin ||
        parameters->rings != RINGS_NONE)
        needed |= 1u << FLUID_SURFACE_TENSION;
    return needed;
}

// From what was given to what the run uses. `conditions_complete` looks up what the
// named liquid has at the temperature; of what is not known it refuses only what this
// run needs, the rest stays NAN. The law of the boundary layer is settled last: without
// a mass transfer coefficient the thickness holds.
static enum status complete_fluids(struct dry_parameters *parameters,
                                   struct reason *reason)
{
    struct conditions *given = &parameters->given;
    struct drying_conditions *conditions = &parameters->conditions;
    const enum status status =
        conditions_complete(given, needed_properties(parameters), reason);
    conditions->temperature = given->temperature;
    conditions->gas_pressure = given->gas_pressure;
    conditions->air_vapour_pressure = given->air_vapour_pressure;
    conditions->saturation_pressure = given->property[FLUID_SATURATION_PRESSURE];
    conditions->diffusivity = given->property[FLUID_DIFFUSIVITY];
    conditions->molar_mass = given->property[FLUID_MOLAR_MASS];
    conditions->liquid_density = given->property[FLUID_DENSITY];
    conditions->viscosity = given->property[FLUID_VISCOSITY];
    conditions->surface_tension = given->property[FLUID_SURFACE_TENSION];
    conditions->contact_angle = given->contact_angle;
    struct air_flow *air = &parameters->air;
    if (isnan(air->kinematic_viscosity))
        air->kinematic_viscosity =
            air_viscosity(given->temperature, given->gas_pressure);
    if (parameters->transfer_law == TRANSFER_COEFFICIENT && isnan(air->coefficient))
        parameters->transfer_law = TRANSFER_THICKNESS;
    return status;
}

double film_step(const struct dry_parameters *parameters, double throats)
{
    const double step = parameters->conditions.films.step;
    return !isnan(step) ? step : throats > MAX_THROATS_BY_FILM_FLOWS ? FILM_STEPS : 0;
}

double flow_step(const struct dry_parameters *parameters, double throats)
{
    const struct drying_conditions *conditions = &parameters->conditions;
    if (!isnan(conditions->flow_step)) return conditions->flow_step;
    const bool at_each = conditions->kelvin || conditions->saturation_step < 1;
    return !at_each && throats > MAX_THROATS_BY_FLOWS ? FLOW_STEPS : 0;
}

double vapour_step(const struct dry_parameters *parameters, double open_nodes,
                   double throats)
{
    const struct drying_conditions *conditions = &parameters->conditions;
    if (!isnan(conditions->vapour_step)) return conditions->vapour_step;
    const bool at_each =
        conditions->kelvin || conditions->vapour_tolerance > 0 ||
        (parameters->liquid == LIQUID_VISCOUS && flow_step(parameters, throats) == 0);
    const double step = at_each ? 0 : default_vapour_step(open_nodes, throats);
    return parameters->rings == RINGS_FILMS ? step / 2 : step;
}

static int count_open_nodes(const struct network *network, unsigned open_walls)
{
    int count = 0;
    for (int i = 0; i < network->n_node; i++)
        count += (network->node_walls[i] & open_walls) != 0;
    return count;
}

// After the network is read, since the default of step_interval depends on its size.
// Fluids come first: they alone can fail, and then nothing has been allocated. A list
// at even intervals replaces `snapshots`; main has refused to have both.
enum status complete_conditions(struct dry_parameters *parameters,
                                const struct network *network, struct reason *reason)
{
    struct drying_conditions *conditions = &parameters->conditions;
    const enum status status = complete_fluids(parameters, reason);
    if (status) return status;
    conditions->liquid = (enum liquid_limit)parameters->liquid;
    conditions->rings = (enum ring_supply)parameters->rings;
    conditions->open_walls = parameters->open_walls;
    conditions->n_snapshot = parameters->snapshots.count;
    conditions->snapshot = parameters->snapshots.value;
    if (parameters->snapshot_interval > 0) {
        parameters->even_snapshots =
            even_snapshots(parameters->snapshot_interval, &conditions->n_snapshot);
        conditions->snapshot = parameters->even_snapshots;
    }
    conditions->layers = (int)parameters->layers;
    conditions->feet = (enum boundary_feet)parameters->feet;
    conditions->lumped = parameters->exchange == EXCHANGE_LUMPED;
    const int n_throat = count_throats(network);
    if (isnan(conditions->step_interval))
        conditions->step_interval = n_throat > MAX_THROATS_BY_EVENTS ? COARSE_STEPS : 0;
    conditions->films.step = film_step(parameters, n_throat);
    conditions->flow_step = flow_step(parameters, n_throat);
    conditions->vapour_step = vapour_step(
        parameters, count_open_nodes(network, parameters->open_walls), n_throat);
    return STATUS_OK;
}
