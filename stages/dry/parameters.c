// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameters.h"

#include "basics/memory.h"
#include "conditions.h"

#include <math.h>
#include <stddef.h>

// Of step_interval: null.
enum { MOST_THROATS_BY_EVENTS = 30000 };
static const double COARSE_STEPS = 1e-3;

#define AT(member) offsetof(struct dry_parameters, member)
#define WALLS "-x|+x|-y|+y|-z|+z"

const struct parameter dry_table[] = {
    {"liquid", PARAMETER_CHOICE, "1", "\"inviscid\"", AT(liquid),
     .choices = "inviscid|immobile|viscous",
     .text = "liquid of negligible viscosity (very slow drying), immobile (very fast) "
             "[K 5.4], or between the two, as viscosity says [K 3.10]"},
    {"viscosity", PARAMETER_NUMBER, "m2 s-1", "1e-6", AT(conditions.viscosity),
     ABOVE(0), .text = "kinematic, of viscous liquid [K Table 3.1]"},
    {"surface_tension", PARAMETER_NUMBER, "N m-1", "0.07274",
     AT(conditions.surface_tension), ABOVE(0),
     .text = "of the liquid; of no effect in inviscid liquid without gravity or kelvin "
             "[K Table 3.1]"},
    {"contact_angle", PARAMETER_NUMBER, "degree", "0", AT(conditions.contact_angle),
     BETWEEN(0, 89.999),
     .text = "imperfect wetting: the capillary pressure is 2 surface_tension cos(this) "
             "/ r"},
    {"gravity", PARAMETER_NUMBER, "m s-2", "0", AT(conditions.gravity), AT_LEAST(0),
     .text = "towards -z: liquid higher up gives way to gas more easily; 0: none"},
    {"knudsen", PARAMETER_BOOLEAN, "1", "false", AT(conditions.knudsen),
     .text = "vapour is held up by the walls of narrow throats too: 1/D + 1/D_K, D_K = "
             "(2/3) r sqrt(8 R T / (pi M))"},
    {"kelvin", PARAMETER_BOOLEAN, "1", "false", AT(conditions.kelvin),
     .text =
         "curved menisci have less vapour, p_sat exp(-p_c M / (rho R T)), p_c = 2 "
         "surface_tension cos(contact_angle) / r of each throat (immobile), of a "
         "cluster's widest meniscus (inviscid), or as the flow makes it (viscous); "
         "vapour also goes from wide throats to narrow ones, and may condense there"},
    {"saturation_step", PARAMETER_NUMBER, "1", "1", AT(conditions.saturation_step),
     BETWEEN(1e-6, 1),
     .text = "viscous: flow is solved anew when a throat's saturation has changed by "
             "this; 1: when one has emptied or filled"},
    {"open", PARAMETER_CHOICES, "1", "[\"+z\"]", AT(open_walls), .choices = WALLS,
     .text = "walls open to the drying air, any set; the others let nothing through"},
    {"imposed_empty", PARAMETER_CHOICES, "1", "[]", AT(imposed_empty),
     .choices = WALLS "|outer|inner",
     .text = "walls whose throats hold no liquid and let nothing through [K 5.4]; "
             "outer and inner: those of a cylinder or sphere around the grains, and of "
             "what is cut out"},
    DRAWN_RADII_ROWS(AT(radii)),
    {"temperature", PARAMETER_NUMBER, "K", "293.15", AT(conditions.temperature),
     ABOVE(0), .text = "temperature [K Table 3.1]"},
    {"gas_pressure", PARAMETER_NUMBER, "Pa", "1e5", AT(conditions.gas_pressure),
     ABOVE(0), .text = "pressure of the gas"},
    {"saturation_pressure", PARAMETER_NUMBER, "Pa", "2339",
     AT(conditions.saturation_pressure), ABOVE(0),
     .text = "equilibrium vapour pressure"},
    {"air_vapour_pressure", PARAMETER_NUMBER, "Pa", "0",
     AT(conditions.air_vapour_pressure), AT_LEAST(0),
     .text = "vapour pressure in the drying air"},
    {"diffusivity", PARAMETER_NUMBER, "m2 s-1", "2.5685e-5", AT(conditions.diffusivity),
     ABOVE(0), .text = "of vapour in the gas"},
    {"molar_mass", PARAMETER_NUMBER, "kg mol-1", "0.01802", AT(conditions.molar_mass),
     ABOVE(0), .text = "of the liquid"},
    {"liquid_density", PARAMETER_NUMBER, "kg m-3", "998.2",
     AT(conditions.liquid_density), ABOVE(0), .text = "of the liquid"},
    {"boundary_layer.from", PARAMETER_CHOICE, "1", "\"mass_transfer\"",
     AT(transfer_law), .choices = "mass_transfer|thickness|sherwood|plate|sphere",
     .text = "what its thickness is found from: the parameters so named, or air that "
             "flows along a plate [K 3.6] or around a sphere (Ranz and Marshall)"},
    {"boundary_layer.mass_transfer", PARAMETER_NUMBER, "m s-1", "5.1",
     AT(air.coefficient), ABOVE(0),
     .text =
         "mass transfer coefficient: the layer is diffusivity / this thick [K 3.3.5]"},
    {"boundary_layer.thickness", PARAMETER_NUMBER, "m", "5e-6", AT(air.thickness),
     ABOVE(0), .text = "thickness"},
    {"boundary_layer.sherwood", PARAMETER_NUMBER, "1", "2", AT(air.sherwood), ABOVE(0),
     .text = "Sherwood number: the layer is flow_length / this thick"},
    {"boundary_layer.flow_length", PARAMETER_NUMBER, "m", "0", AT(air.length),
     AT_LEAST(0),
     .text = "sherwood, plate, sphere: length of the body along the flow, or its "
             "diameter; 0: the longer edge of the open side of the box"},
    {"boundary_layer.air_velocity", PARAMETER_NUMBER, "m s-1", "1", AT(air.velocity),
     AT_LEAST(0), .text = "plate, sphere: of the air"},
    {"boundary_layer.kinematic_viscosity", PARAMETER_NUMBER, "m2 s-1", "1.53e-5",
     AT(air.kinematic_viscosity), ABOVE(0),
     .text = "plate, sphere: of the air; dry, 293 K, 1 bar"},
    {"boundary_layer.exchange", PARAMETER_CHOICE, "1", "\"lattice\"", AT(exchange),
     .choices = "lattice|lumped",
     .text =
         "layers of nodes between which vapour also goes sideways, or none: each node "
         "of the surface exchanges with the air by the mass transfer coefficient"},
    {"boundary_layer.columns", PARAMETER_CHOICE, "1", "\"surface\"", AT(feet),
     .choices = "surface|auxiliary",
     .text = "nodes it stands on: all of the surface, or those where throats of an "
             "auxiliary layer of grains begin (pack.extra_layer) [K 3.3.5]"},
    {"boundary_layer.layers", PARAMETER_INTEGER, "1", "0", AT(layers),
     BETWEEN(0, 10000), .text = "layers of nodes in it; 0: spaced as throats are long"},
    {"start_saturation", PARAMETER_NUMBER, "1", "1", AT(conditions.start_saturation),
     BETWEEN(1e-9, 1),
     .text = "liquid at the start, of the throats' volume: what is left when gas has "
             "come in through the open walls, always into the throat it enters most "
             "easily; where INPUT is a drying, its state when it had as much; of no "
             "effect where INPUT says how full its throats are"},
    {"start_trapping", PARAMETER_BOOLEAN, "1", "false", AT(conditions.start_trapping),
     .text =
         "as gas comes in for start_saturation, liquid leaves only through the closed "
         "walls opposite the open ones: what gas has cut off from them stays"},
    {"stop_saturation", PARAMETER_NUMBER, "1", "0", AT(conditions.stop_saturation),
     BETWEEN(0, 0.999999), .text = "liquid at the end, of the throats' volume; 0: dry"},
    {"vapour_tolerance", PARAMETER_NUMBER, "1", "0", AT(conditions.vapour_tolerance),
     BETWEEN(0, 0.5),
     .text = "largest error of what wet nodes evaporate, all errors added up, over the "
             "rate, 1e-6 or more: links between the nodes of large fronts are kept to "
             "seven digits; 0: exact"},
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
     .text = "in place of snapshots: the fall of the saturation, from 1, from one to "
             "the next, at least 1e-4; 0: as listed"},
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

void complete_conditions(struct dry_parameters *parameters,
                         const struct network *network)
{
    struct drying_conditions *conditions = &parameters->conditions;
    conditions->liquid = (enum liquid_limit)parameters->liquid;
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
    if (isnan(conditions->step_interval))
        conditions->step_interval =
            count_throats(network) > MOST_THROATS_BY_EVENTS ? COARSE_STEPS : 0;
}
