// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters, and what follows from them: the kind of bonds, the liquid of bridges,
// and the engine. With engine=auto equilibria are taken only where each load has one of
// its own, found quickly (suits_equilibria); everything else runs by cycles.
//
// Defaults are K's aggregate [K Table 5.1]: grains of 250 nm. warn_of_defaults tells
// those who have other grains.
//
// Rows in this order: the material of grains and contacts; bonds, their strengths and
// who has them; prestress and shrinkage; what holds the body; the engine, first that by
// equilibria; bridges; time steps and cycles of the explicit engine; what is written.
// Most rows fill `settings` as it is. Choices go to members of their own, as int, and
// are cast in complete_settings to enums of the same order.
//
// main completes in this order: complete_settings; complete_bridges, once the forces
// are open; choose_engine, once bonds are known; held grains, strengths and weight in
// main.c and take_weight.c.
//
// Traps: a parallel bond is given by stiffness and strength per area, a contact bond by
// a force, and the other's numbers are not looked at. With engine=auto a wet, shrinking
// or frictional scene runs by cycles whatever else is said; quasi_static.* then does
// nothing.
#include "parameters.h"

#include "replay_engine.h"

#include <math.h>
#include <stddef.h>

#define AT(member) offsetof(struct replay_parameters, member)

const struct parameter replay_table[] = {
    {"density", PARAMETER_NUMBER, "kg m-3", "3230", AT(settings.material.density),
     ABOVE(0), .text = "of the grains [K Table 5.1]"},
    {"gravity", PARAMETER_NUMBER_OR_NULL, "m s-2", "null", AT(gravity), AT_LEAST(0),
     .text = "towards -z: the weight of the grains, and of the liquid in the forces, "
             "loads the body, which comes to rest under it before drying begins; null: "
             "that of the forces (dry.gravity, force-protocol.gravity), 0 with "
             "support=free; 0: grains have no weight"},
    {"friction", PARAMETER_NUMBER, "1", "0.5", AT(settings.material.friction),
     AT_LEAST(0), .text = "coefficient between grains"},
    {"damping_ratio", PARAMETER_NUMBER, "1", "0", AT(settings.material.damping_ratio),
     AT_LEAST(0),
     .text = "damping of the dashpots at contacts, over critical damping [K 4.28]"},
    {"tensile_damping", PARAMETER_BOOLEAN, "1", "true", AT(settings.tensile_damping),
     .text = "dashpots may pull grains that separate; false: the normal force of a "
             "contact without a bond is never below 0 [G 3]"},
    {"local_damping", PARAMETER_NUMBER, "1", "0.7", AT(settings.material.local_damping),
     BETWEEN(0, 0.99),
     .text =
         "share of the net force on a grain: subtracted while the grain moves along "
         "the force, added while it moves against it, so that it comes to rest"},
    {"normal_stiffness", PARAMETER_NUMBER, "N m-1", "3e4",
     AT(settings.material.normal_stiffness), AT_LEAST(0),
     .text = "of a grain; a contact is two of these in series [K 4.22]"},
    {"shear_stiffness", PARAMETER_NUMBER, "N m-1", "3e4",
     AT(settings.material.shear_stiffness), AT_LEAST(0), .text = "of a grain"},
    {"bond.normal_stiffness", PARAMETER_NUMBER, "N m-3", "8e14",
     AT(settings.bond.normal_stiffness), AT_LEAST(0),
     .text = "of parallel bonds, per area"},
    {"bond.shear_stiffness", PARAMETER_NUMBER, "N m-3", "8e14",
     AT(settings.bond.shear_stiffness), AT_LEAST(0),
     .text = "of parallel bonds, per area"},
    {"bond.normal_strength", PARAMETER_NUMBER, "N m-2", "1.6e4",
     AT(settings.bond.normal_strength), AT_LEAST(0),
     .text = "tensile stress that breaks a bond [K 4.41]"},
    {"bond.shear_strength", PARAMETER_NUMBER, "N m-2", "1.6e4",
     AT(settings.bond.shear_strength), AT_LEAST(0),
     .text = "shear stress that breaks a bond [K 4.42]"},
    {"bond.radius_fraction", PARAMETER_NUMBER, "1", "0.5858",
     AT(settings.bond.radius_fraction), BETWEEN(1e-6, 1),
     .text = "bond radius over the radius of the smaller grain"},
    {"bond.moment_contribution", PARAMETER_NUMBER, "1", "1", AT(moment_contribution),
     BETWEEN(0, 1),
     .text = "parallel bonds: share of bending and twist in the stress that breaks "
             "them [K 4.41: 1]; beta of PFC"},
    {"bond.by", PARAMETER_CHOICE, "1", "\"packing\"", AT(bonds_by),
     .choices = "packing|touching|distance|none",
     .text = "which grains are bonded: those the packing lists, those that touch, "
             "those within bond.gap, or none: contacts and bridges alone"},
    {"bond.gap", PARAMETER_NUMBER, "1", "0.01", AT(bond_gap), BETWEEN(0, 10),
     .text =
         "by=distance: largest gap that a bond spans, over the sum of the two radii"},
    {"bond.strength.distribution", PARAMETER_CHOICE, "1", "\"one\"", AT(strength_law),
     .choices = "one|normal|weibull",
     .text = "distribution of the strengths around those above, one number per bond "
             "for tension and shear; normal: cut off at 0"},
    {"bond.strength.variation", PARAMETER_NUMBER, "1", "0.2", AT(scatter.variation),
     BETWEEN(0, 1), .text = "normal: standard deviation over mean, before the cut"},
    {"bond.strength.modulus", PARAMETER_NUMBER, "1", "5", AT(scatter.modulus),
     BETWEEN(0.5, 1e6), .text = "Weibull: m; the strengths above stay the means"},
    {"bond.strength.seed", PARAMETER_INTEGER, "1", "1", AT(scatter.seed),
     BETWEEN(1, 4294967295),
     .text = "of the strengths (mt19937), drawn in the order of the places of bonds"},
    {"bond.substrate_strength", PARAMETER_NUMBER, "1", "1", AT(substrate_strength),
     AT_LEAST(0),
     .text = "support=fixed: factor on the strength of bonds between a held grain, the "
             "substrate, and one that is not"},
    {"bond.kind", PARAMETER_CHOICE, "1", "\"parallel\"", AT(bond),
     .choices = "parallel|contact",
     .text = "parallel: elastic cylinders [K 4.31-4.44]; contact: the springs of the "
             "contact, which also pull and do not slip [K 4.2]"},
    {"bond.contact_strength", PARAMETER_NUMBER, "N", "null", AT(contact_strength),
     AT_LEAST(0),
     .text = "tension or shear force that breaks a contact bond; null: no force does"},
    {"prestress", PARAMETER_BOOLEAN, "1", "false", AT(prestress),
     .text = "true: overlaps of the packing push from the start; false: they do not, "
             "only further approach does"},
    {"shrinkage.strain", PARAMETER_NUMBER, "1", "0", AT(settings.shrinkage.strain),
     BETWEEN(0, 0.5),
     .text = "drying shrinkage, the linear strain by which dry grains and "
             "their bonds are smaller without stress; never swells back; 0: none"},
    {"shrinkage.law", PARAMETER_CHOICE, "1", "\"uniform\"", AT(shrinkage_law),
     .choices = "uniform|front|liquid",
     .text = "uniform: as the saturation falls, everywhere; front: behind a drying "
             "front from the top; liquid: as the liquid around each grain goes "
             "(/liquid_mass, with force-protocol.gravity above 0)"},
    {"shrinkage.front_width", PARAMETER_NUMBER_OR_NULL, "1", "null",
     AT(settings.shrinkage.front_width), ABOVE(0),
     .text = "law=front: from where shrinking begins to where it ends, in mean "
             "diameters; null: the height of the body"},
    {"shrinkage.steps", PARAMETER_INTEGER, "1", "40", AT(shrinkage_steps),
     BETWEEN(1, 1e6),
     .text = "steps of a load without forces, where the input is a packing: saturation "
             "falls evenly to 0, a step a second"},
    {"capillary.suction", PARAMETER_NUMBER, "Pa", "0", AT(settings.capillarity.suction),
     AT_LEAST(0),
     .text = "explicit: the largest suction of liquid in the pores of a packing, which "
             "gas enters from the upper z side as grains move and bonds break; menisci "
             "pull at the grains where they are; 0: none"},
    {"capillary.control", PARAMETER_CHOICE, "1", "\"suction\"", AT(capillary_control),
     .choices = "suction|evaporation",
     .text =
         "suction: it rises evenly, and gas enters what it can; evaporation: liquid "
         "goes evenly from the widest throats, and the suction is what they need"},
    {"capillary.steps", PARAMETER_INTEGER, "1", "40", AT(settings.capillarity.steps),
     BETWEEN(1, 1e6), .text = "of the load, a second each"},
    {"capillary.evaporated", PARAMETER_NUMBER, "1", "0.8",
     AT(settings.capillarity.last_drained), BETWEEN(1e-6, 1),
     .text =
         "control=evaporation: share of the liquid that pores lose to gas by the end"},
    {"capillary.round", PARAMETER_INTEGER, "1", "32", AT(settings.capillarity.round),
     BETWEEN(1, 1e12),
     .text = "time steps between two entries of gas, of one pore each way"},
    {"capillary.rounds", PARAMETER_INTEGER, "1", "32", AT(settings.capillarity.rounds),
     BETWEEN(1, 1e6),
     .text = "control=evaporation: entries of gas in a step of the load"},
    {"capillary.forces", PARAMETER_CHOICE, "1", "\"present\"", AT(capillary_forces),
     .choices = "present|first",
     .text = "menisci pull on the facets between the grains as they are, or (one way) "
             "as they were at first"},
    {"capillary.throats", PARAMETER_CHOICE, "1", "\"present\"", AT(capillary_throats),
     .choices = "present|first",
     .text =
         "gas enters throats as wide as grains have left them, or (one way) as they "
         "were at first"},
    {"capillary.surface_tension", PARAMETER_NUMBER, "N m-1", "null",
     AT(pore_liquid.surface_tension), ABOVE(0), .shared = true,
     .text = "of the liquid in the pores; null: that of water at 293.15 K"},
    {"capillary.contact_angle", PARAMETER_NUMBER, "degree", "null",
     AT(pore_liquid.contact_angle), BETWEEN(0, 89.999), .shared = true,
     .text = "of the liquid in the pores; null: 0"},
    {"support", PARAMETER_CHOICE, "1", "\"fixed\"", AT(support),
     .choices = "free|fixed|wall",
     .text = "free: net force and moment are removed; fixed: the grains of held "
             "neither move nor turn; wall: a rigid wall at the lower z side"},
    {"held.walls", PARAMETER_CHOICES, "1", "[\"-z\"]", AT(held.walls),
     .choices = "-x|+x|-y|+y|-z|+z",
     .text = "support=fixed: holds the grains that touch these sides"},
    {"held.grains", PARAMETER_LIST, "1", "[]", AT(held.grains), AT_LEAST(0),
     .text = "support=fixed: holds these grains as well, by number"},
    {"held.lower", PARAMETER_POINT, "m", "null", AT(held.lower),
     .text = "support=fixed: holds grains with their centres in a box as well; its "
             "lower corner"},
    {"held.upper", PARAMETER_POINT, "m", "null", AT(held.upper),
     .text = "upper corner of this box"},
    {"loose_grains", PARAMETER_CHOICE, "1", "\"unload\"", AT(loose),
     .choices = "keep|unload",
     .text = "explicit: grains that no intact bonds join to a held grain or, if none "
             "is held, to the largest fragment; keep: their load stays, and they may "
             "fly away; unload: the net force and moment of their load are removed"},
    {"engine", PARAMETER_CHOICE, "1", "\"auto\"", AT(engine),
     .choices = "explicit|quasi-static|auto",
     .text = "explicit: time steps of discrete elements [K 4]; quasi-static: "
             "equilibria, bonds break one by one; auto: quasi-static without friction, "
             "where it is far faster, else explicit"},
    {"quasi_static.tolerance", PARAMETER_NUMBER, "1", "1e-8",
     AT(settings.equilibrium_tolerance), ABOVE(0),
     .text = "largest residual force or moment on a grain, over the largest load, or "
             "push of an overlap at the start"},
    {"quasi_static.most_iterations", PARAMETER_INTEGER, "1", "40",
     AT(settings.most_iterations), BETWEEN(1, 1e9),
     .text = "most steps in time, slowed by dashpots, if equilibrium is not found at "
             "once (with large displacements: most without progress); grains that "
             "still move after these go on under the next load"},
    {"quasi_static.rolling_stiffness", PARAMETER_NUMBER, "1", "1e-3",
     AT(settings.rolling), BETWEEN(0, 1),
     .text = "contact bonds: resistance to rolling and torsion, over the shear "
             "stiffness times the arms of both grains; 0: none, and grains that turn "
             "like gears are not held"},
    {"quasi_static.large_displacements", PARAMETER_BOOLEAN, "1", "false",
     AT(settings.large_displacements),
     .text = "true: grains may move and turn far, equilibria are those of the current "
             "geometry; false: displacements are small, directions are those of the "
             "packing"},
    {"quasi_static.increment", PARAMETER_NUMBER, "1", "0.02", AT(settings.increment),
     BETWEEN(1e-6, 0.1),
     .text = "with large displacements: largest rotation of a grain or a contact in "
             "one increment, in rad, or approach of two grains, in mean radii; the "
             "error falls with its square"},
    {"bridges.volume", PARAMETER_NUMBER, "m3", "0", AT(settings.liquid.volume),
     AT_LEAST(0),
     .text = "volume of the liquid bridge between two grains that touch [G 2]; with "
             "shared, of the liquid of each grain; 0: no bridges"},
    {"bridges.shared", PARAMETER_BOOLEAN, "1", "false", AT(settings.liquid.shared),
     .text = "each grain divides its liquid evenly among its bridges"},
    {"bridges.surface_tension", PARAMETER_NUMBER, "N m-1", "null",
     AT(bridge_liquid.surface_tension), ABOVE(0), .shared = true,
     .text = "of their liquid; null: that of the forces or, if they have none, that of "
             "water at 293.15 K"},
    {"bridges.contact_angle", PARAMETER_NUMBER, "degree", "null",
     AT(bridge_liquid.contact_angle), BETWEEN(0, 170), .shared = true,
     .text = "of their liquid; null: that of the forces or, if they have none, 0"},
    {"bridges.model", PARAMETER_CHOICE, "1", "\"table\"", AT(bridge_model),
     .choices = BRIDGE_MODEL_CHOICES,
     .text = "model of their force; table: the exact solution, interpolated; the "
             "others are fits"},
    {"bridges.pull_in_contact", PARAMETER_BOOLEAN, "1", "true",
     AT(settings.liquid.pulls_in_contact),
     .text = "true: bridges also pull where grains overlap; false: only across a gap "
             "[G 4]"},
    {"time_step_safety", PARAMETER_NUMBER_OR_NULL, "1", "null",
     AT(settings.time_step_safety), ABOVE(0),
     .text = "time step over the critical one of two grains [K 4.47]; null: half the "
             "stability limit of the aggregate"},
    {"density_scaling", PARAMETER_BOOLEAN, "1", "true", AT(settings.density_scaling),
     .text =
         "explicit: every grain has the inertia of the mean one, so that small ones "
         "do not shorten the time step; equilibria do not depend on it"},
    {"allow_unstable", PARAMETER_BOOLEAN, "1", "false", AT(settings.force_time_step),
     .text = "run past the stability limit of the aggregate"},
    {"cycles", PARAMETER_INTEGER, "1", "100", AT(settings.cycles), BETWEEN(1, 1e12),
     .text = "time steps at each step of the forces [K 5.2]"},
    {"ramp", PARAMETER_INTEGER, "1", "5000", AT(settings.ramp), BETWEEN(0, 1e12),
     .text = "explicit: time steps over which the first load grows, before its cycles; "
             "0: it acts at once"},
    {"tolerance", PARAMETER_NUMBER_OR_NULL, "1", "1e-3", AT(settings.tolerance),
     ABOVE(0),
     .text = "after its cycles each step continues until the unbalanced ratio [K 4.20] "
             "is below this; null: it does not"},
    {"most_cycles", PARAMETER_INTEGER, "1", "10000", AT(settings.most_cycles),
     BETWEEN(1, 1e12),
     .text = "most time steps at one step of the forces; a step that needs more is "
             "unsettled"},
    {"unsettled", PARAMETER_CHOICE, "1", "\"count\"", AT(unsettled),
     .choices = "stop|count",
     .text = "with tolerance: a step that did not come to rest within most_cycles ends "
             "the replay with status 3, or is counted"},
    {"snapshots", PARAMETER_LIST, "1", "[1,0.9,0.75,0.6,0.3,0]", AT(snapshots),
     BETWEEN(0, 1),
     .text = "saturations at which displacements and contact forces are kept, highest "
             "first"},
    {"keep_state", PARAMETER_BOOLEAN, "1", "false", AT(settings.keep_state),
     .text = "write the final state as well, with a snapshot, for another replay to "
             "continue from; for equilibria all loads so far, from which that replay "
             "finds them again"},
    {0}};

// The replay takes snapshots in this order, each at the first load at or below its
// saturation.
static void check_snapshots(const struct number_list *snapshots)
{
    for (int k = 1; k < snapshots->count; k++)
        if (snapshots->value[k] >= snapshots->value[k - 1])
            die(STATUS_BAD_DATA,
                "dem-replay.snapshots: must fall from one to the next, got "
                "%g after %g",
                snapshots->value[k], snapshots->value[k - 1]);
}

// Strengths of parallel bonds are stresses, those of contact bonds forces. A contact
// bond without a given strength never breaks. beta = moment_contribution; the engine
// asks for what is left out, so that a setup of zeros counts moments whole.
static void choose_bonds(const struct replay_parameters *parameters,
                         struct replay_settings *settings)
{
    settings->bond.kind = (enum dem_bond_kind)parameters->bond;
    settings->bond.moments_left_out = 1 - parameters->moment_contribution;
    if (settings->bond.kind == DEM_PARALLEL_BOND) return;
    const double strength = parameters->contact_strength;
    settings->bond.normal_strength = isnan(strength) ? INFINITY : strength;
    settings->bond.shear_strength = settings->bond.normal_strength;
}

// What the user leaves open comes from the forces, and what these leave open from water
// at 20 degrees Celsius. The engine wants the contact angle in radians. A difference is
// told only where there are bridges; without them the liquid does nothing here.
const char *complete_bridges(struct replay_parameters *parameters,
                             const struct artifact *forces, char *difference,
                             size_t size)
{
    const struct liquid_properties water = {
        .surface_tension =
            fluid_value(FLUID_WATER, FLUID_SURFACE_TENSION, 293.15, 1e5)};
    const struct liquid_properties unknown = {NAN, NAN, NAN, NAN, NAN, NAN};
    const struct liquid_properties has = forces ? artifact_get_liquid(forces) : unknown;
    struct liquid_properties *told = &parameters->bridge_liquid;
    liquid_complete(told, &has);
    liquid_complete(told, &water);
    struct dem_liquid *liquid = &parameters->settings.liquid;
    liquid->surface_tension = told->surface_tension;
    liquid->contact_angle = told->contact_angle * (M_PI / 180);
    difference[0] = '\0';
    if (liquid->volume > 0) liquid_differs(told, &has, "the forces", difference, size);
    return difference;
}

// Without friction each load has one equilibrium, which does not depend on the loads
// before it and is found quickly (docs/equilibrium.md). Up to MOST_GRAINS only: the
// cost of a factor grows faster than that of a time step (docs/engines.md).
static bool suits_equilibria(const struct replay_settings *settings,
                             const struct packing *packing)
{
    enum { MOST_GRAINS = 1500 };
    return !(settings->material.friction > 0) && settings->support == SUPPORT_FIXED &&
           settings->bond.kind == DEM_PARALLEL_BOND && settings->unstressed &&
           !(settings->liquid.volume > 0) && packing->n_bond > 0 &&
           !(settings->shrinkage.strain > 0) && !(settings->capillarity.suction > 0) &&
           packing->n_particle <= MOST_GRAINS;
}

// For the provenance: which of the reasons it was.
static const char *why_cycles(const struct replay_settings *settings)
{
    return settings->material.friction > 0  ? "contacts have friction"
           : settings->shrinkage.strain > 0 ? "grains shrink"
           : settings->capillarity.suction > 0
               ? "liquid drains from the pores"
               : "bonds, support, liquid bridges or the number of grains do not suit "
                 "equilibria";
}

// Also an engine that the user names is asked whether it can do all that is wanted:
// better refused before the replay than left out of it.
void choose_engine(const struct replay_parameters *parameters,
                   const struct packing *packing, struct replay_settings *settings)
{
    enum { AUTO = 2 };
    const bool suits = suits_equilibria(settings, packing);
    if (parameters->engine != AUTO) {
        settings->engine = (enum engine)parameters->engine;
        settings->engine_reason = "as the parameters say";
    } else {
        settings->engine = suits ? ENGINE_QUASI_STATIC : ENGINE_EXPLICIT;
        settings->engine_reason =
            suits ? "no friction, parallel bonds, few grains" : why_cycles(settings);
    }
    const struct replay_engine *engine = replay_engine(settings);
    struct reason reason;
    const enum status status =
        engine->check ? engine->check(settings, &reason) : STATUS_OK;
    if (status) die(status, "%s", reason.text);
}

static void complete_capillarity(struct replay_parameters *parameters)
{
    struct capillarity *how = &parameters->settings.capillarity;
    const struct liquid_properties water = {
        .surface_tension =
            fluid_value(FLUID_WATER, FLUID_SURFACE_TENSION, 293.15, 1e5)};
    liquid_complete(&parameters->pore_liquid, &water);
    how->tension = parameters->pore_liquid.surface_tension *
                   cos(parameters->pore_liquid.contact_angle * (M_PI / 180));
    how->control = (enum capillary_control)parameters->capillary_control;
    how->forces = (enum geometry_of)parameters->capillary_forces;
    how->throats = (enum geometry_of)parameters->capillary_throats;
}

void complete_settings(struct replay_parameters *parameters, int threads)
{
    struct replay_settings *settings = &parameters->settings;
    check_snapshots(&parameters->snapshots);
    settings->support = (enum support)parameters->support;
    settings->loose = (enum loose_loads)parameters->loose;
    settings->unsettled = (enum unsettled)parameters->unsettled;
    settings->unstressed = !parameters->prestress;
    settings->shrinkage.law = (enum shrinkage_law)parameters->shrinkage_law;
    settings->liquid.model = (enum bridge_model)parameters->bridge_model;
    choose_bonds(parameters, settings);
    complete_capillarity(parameters);
    settings->n_snapshot = parameters->snapshots.count;
    settings->snapshot = parameters->snapshots.value;
    settings->threads = threads;
}
