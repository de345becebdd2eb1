// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameters.h"

#include "replay_engine.h"

#include <math.h>
#include <stddef.h>

#define AT(member) offsetof(struct replay_parameters, member)

const struct parameter replay_table[] = {
    {"density", PARAMETER_NUMBER, "kg m-3", "3230", BOUND_ABOVE, 0, 0, NULL,
     "of the grains [K Table 5.1]", AT(settings.material.density)},
    {"friction", PARAMETER_NUMBER, "1", "0.5", BOUND_MINIMUM, 0, 0, NULL,
     "coefficient between grains", AT(settings.material.friction)},
    {"damping_ratio", PARAMETER_NUMBER, "1", "0.7", BOUND_MINIMUM, 0, 0, NULL,
     "of the dashpots at contacts, of critical [K 4.28]",
     AT(settings.material.damping_ratio)},
    {"local_damping", PARAMETER_NUMBER, "1", "0", BOUND_BETWEEN, 0, 0.99, NULL,
     "share of the net force on a grain taken off while it moves its way, added while "
     "it moves against it; for statics",
     AT(settings.material.local_damping)},
    {"normal_stiffness", PARAMETER_NUMBER, "N m-1", "3e4", BOUND_MINIMUM, 0, 0, NULL,
     "of a grain; two in series make a contact [K 4.22]",
     AT(settings.material.normal_stiffness)},
    {"shear_stiffness", PARAMETER_NUMBER, "N m-1", "3e4", BOUND_MINIMUM, 0, 0, NULL,
     "of a grain", AT(settings.material.shear_stiffness)},
    {"bond.normal_stiffness", PARAMETER_NUMBER, "N m-3", "8e14", BOUND_MINIMUM, 0, 0,
     NULL, "of parallel bonds, per area", AT(settings.bond.normal_stiffness)},
    {"bond.shear_stiffness", PARAMETER_NUMBER, "N m-3", "8e14", BOUND_MINIMUM, 0, 0,
     NULL, "of parallel bonds, per area", AT(settings.bond.shear_stiffness)},
    {"bond.normal_strength", PARAMETER_NUMBER, "N m-2", "1.6e4", BOUND_MINIMUM, 0, 0,
     NULL, "tensile stress that breaks a bond [K 4.41]",
     AT(settings.bond.normal_strength)},
    {"bond.shear_strength", PARAMETER_NUMBER, "N m-2", "1.6e4", BOUND_MINIMUM, 0, 0,
     NULL, "shear stress that breaks a bond [K 4.42]",
     AT(settings.bond.shear_strength)},
    {"bond.radius_fraction", PARAMETER_NUMBER, "1", "0.5858", BOUND_BETWEEN, 1e-6, 1,
     NULL, "bond radius, of the smaller grain's", AT(settings.bond.radius_fraction)},
    {"bond.by", PARAMETER_CHOICE, "1", "\"packing\"", BOUND_NONE, 0, 0,
     "packing|touching|distance",
     "which grains are bonded: those the packing lists, those that touch, or those "
     "within bond.gap",
     AT(bonds_by)},
    {"bond.gap", PARAMETER_NUMBER, "1", "0.01", BOUND_BETWEEN, 0, 10, NULL,
     "largest gap that a bond spans, of the sum of the two radii; for by=distance",
     AT(bond_gap)},
    {"bond.strength.distribution", PARAMETER_CHOICE, "1", "\"one\"", BOUND_NONE, 0, 0,
     "one|normal|weibull",
     "of the strengths of bonds about those above, one number a bond for tension and "
     "shear; normal: cut off at 0",
     AT(strength_law)},
    {"bond.strength.variation", PARAMETER_NUMBER, "1", "0.2", BOUND_BETWEEN, 0, 1, NULL,
     "normal: standard deviation over mean, before the cut", AT(scatter.variation)},
    {"bond.strength.modulus", PARAMETER_NUMBER, "1", "5", BOUND_BETWEEN, 0.5, 1e6, NULL,
     "Weibull: m; the strengths above stay the means", AT(scatter.modulus)},
    {"bond.strength.seed", PARAMETER_INTEGER, "1", "1", BOUND_BETWEEN, 1, 4294967295,
     NULL, "of the strengths (mt19937), drawn in the order of the places of bonds",
     AT(scatter.seed)},
    {"bond.kind", PARAMETER_CHOICE, "1", "\"parallel\"", BOUND_NONE, 0, 0,
     "parallel|contact",
     "parallel: cylinders of glue [K 4.31-4.44]; contact: the contact's own springs "
     "also in tension, without slip [K 4.2]",
     AT(bond)},
    {"bond.contact_strength", PARAMETER_NUMBER, "N", "null", BOUND_MINIMUM, 0, 0, NULL,
     "tension or shear force that breaks a contact bond; null: none does",
     AT(contact_strength)},
    {"prestress", PARAMETER_BOOLEAN, "1", "false", BOUND_NONE, 0, 0, NULL,
     "overlaps of the packing push from the start; false: grains lie at rest, and what "
     "they come closer pushes",
     AT(prestress)},
    {"support", PARAMETER_CHOICE, "1", "\"fixed\"", BOUND_NONE, 0, 0, "free|fixed|wall",
     "free: net force and moment are taken off; fixed: the grains of held neither move "
     "nor turn; wall: a rigid wall at the lower z side",
     AT(support)},
    {"held.walls", PARAMETER_CHOICES, "1", "[\"-z\"]", BOUND_NONE, 0, 0,
     "-x|+x|-y|+y|-z|+z", "for support=fixed: the grains that touch these sides",
     AT(held.walls)},
    {"held.grains", PARAMETER_LIST, "1", "[]", BOUND_MINIMUM, 0, 0, NULL,
     "and these, by number", AT(held.grains)},
    {"held.lower", PARAMETER_POINT, "m", "null", BOUND_NONE, 0, 0, NULL,
     "and those with their centres between this corner", AT(held.lower)},
    {"held.upper", PARAMETER_POINT, "m", "null", BOUND_NONE, 0, 0, NULL, "and this one",
     AT(held.upper)},
    {"engine", PARAMETER_CHOICE, "1", "\"explicit\"", BOUND_NONE, 0, 0,
     "explicit|quasi-static",
     "explicit: cycles of discrete elements [K 4]; quasi-static: equilibrium itself, "
     "bonds breaking one by one",
     AT(engine)},
    {"quasi_static.tolerance", PARAMETER_NUMBER, "1", "1e-8", BOUND_ABOVE, 0, 0, NULL,
     "largest force or moment left on a grain, of the largest load",
     AT(settings.equilibrium_tolerance)},
    {"quasi_static.most_iterations", PARAMETER_INTEGER, "1", "40", BOUND_BETWEEN, 1,
     1e9, NULL,
     "steps in time, slowed by dashpots, where equilibrium is not found at once; what "
     "still moves then goes on under the next load",
     AT(settings.most_iterations)},
    {"quasi_static.rolling_stiffness", PARAMETER_NUMBER, "1", "1e-3", BOUND_BETWEEN, 0,
     1, NULL,
     "contact bonds: what resists rolling and twist, of the shear stiffness times the "
     "arms of both grains; 0: nothing, and grains that turn like gears are not held",
     AT(settings.rolling)},
    {"quasi_static.large_displacements", PARAMETER_BOOLEAN, "1", "false", BOUND_NONE, 0,
     0, NULL,
     "grains may move and turn far: equilibrium on the geometry as it is; false: "
     "directions are those of the packing, displacements small",
     AT(settings.large_displacements)},
    {"quasi_static.increment", PARAMETER_NUMBER, "1", "0.02", BOUND_BETWEEN, 1e-6, 0.1,
     NULL,
     "with large displacements: how far a grain or a contact turns at a time, in rad, "
     "or grains come closer, in mean radii; the error falls with its square",
     AT(settings.increment)},
    {"bridges.volume", PARAMETER_NUMBER, "m3", "0", BOUND_MINIMUM, 0, 0, NULL,
     "of a liquid bridge between each two grains that touch [G 2], or with shared on "
     "each grain; 0: none",
     AT(settings.liquid.volume)},
    {"bridges.shared", PARAMETER_BOOLEAN, "1", "false", BOUND_NONE, 0, 0, NULL,
     "each grain parts its liquid evenly among its bridges",
     AT(settings.liquid.shared)},
    {"bridges.surface_tension", PARAMETER_NUMBER, "N m-1", "0.07274", BOUND_ABOVE, 0, 0,
     NULL, "of their liquid", AT(settings.liquid.surface_tension)},
    {"bridges.contact_angle", PARAMETER_NUMBER, "degree", "0", BOUND_BETWEEN, 0, 170,
     NULL, "of their liquid", AT(settings.liquid.contact_angle)},
    {"bridges.model", PARAMETER_CHOICE, "1", "\"willett-full\"", BOUND_NONE, 0, 0,
     BRIDGE_MODEL_CHOICES,
     "of their force; table, of the exact solution, needs grains of one radius",
     AT(bridge_model)},
    {"bridges.pull_in_contact", PARAMETER_BOOLEAN, "1", "true", BOUND_NONE, 0, 0, NULL,
     "also where grains overlap; false: only apart [G 4]",
     AT(settings.liquid.pulls_in_contact)},
    {"time_step_safety", PARAMETER_NUMBER_OR_NULL, "1", "0.045", BOUND_ABOVE, 0, 0,
     NULL,
     "time step, of the critical one of two grains [K 4.47]; null: half the "
     "stability limit of the aggregate",
     AT(settings.time_step_safety)},
    {"allow_unstable", PARAMETER_BOOLEAN, "1", "false", BOUND_NONE, 0, 0, NULL,
     "run past the stability limit of the aggregate", AT(settings.force_time_step)},
    {"cycles", PARAMETER_INTEGER, "1", "500", BOUND_BETWEEN, 1, 1e12, NULL,
     "time steps at each step of the forces [K 5.2]", AT(settings.cycles)},
    {"ramp", PARAMETER_INTEGER, "1", "0", BOUND_BETWEEN, 0, 1e12, NULL,
     "explicit: time steps over which the first load grows, before its cycles; 0: it "
     "comes at once",
     AT(settings.ramp)},
    {"tolerance", PARAMETER_NUMBER, "1", "null", BOUND_ABOVE, 0, 0, NULL,
     "then go on until the unbalanced ratio [K 4.20] is below this; null: go on at "
     "once",
     AT(settings.tolerance)},
    {"most_cycles", PARAMETER_INTEGER, "1", "1000000", BOUND_BETWEEN, 1, 1e12, NULL,
     "more time steps than this at one step of the forces: not converged",
     AT(settings.most_cycles)},
    {"snapshots", PARAMETER_LIST, "1", "[1,0.9,0.75,0.6,0.3,0]", BOUND_BETWEEN, 0, 1,
     NULL,
     "saturations at which displacements and contact forces are kept, highest first",
     AT(snapshots)},
    {"keep_state", PARAMETER_BOOLEAN, "1", "false", BOUND_NONE, 0, 0, NULL,
     "the end goes into the output as well, with a snapshot, for another replay to go "
     "on from; of equilibria all loads so far, from which that finds them once more",
     AT(settings.keep_state)},
    {0}};

static void check_snapshots(const struct number_list *snapshots)
{
    for (int k = 1; k < snapshots->count; k++)
        if (snapshots->value[k] >= snapshots->value[k - 1])
            die(STATUS_BAD_DATA,
                "dem-replay.snapshots: must fall from one to the next, got "
                "%g after %g",
                snapshots->value[k], snapshots->value[k - 1]);
}

// Strengths of parallel bonds are stresses, those of contact bonds forces.
static void choose_bonds(const struct replay_parameters *parameters,
                         struct replay_settings *settings)
{
    settings->bond.kind = (enum dem_bond_kind)parameters->bond;
    if (settings->bond.kind == DEM_PARALLEL_BOND) return;
    const double strength = parameters->contact_strength;
    settings->bond.normal_strength = isnan(strength) ? INFINITY : strength;
    settings->bond.shear_strength = settings->bond.normal_strength;
}

void complete_settings(struct replay_parameters *parameters, int threads)
{
    struct replay_settings *settings = &parameters->settings;
    check_snapshots(&parameters->snapshots);
    settings->support = (enum support)parameters->support;
    settings->engine = (enum engine)parameters->engine;
    settings->unstressed = !parameters->prestress;
    settings->liquid.model = (enum bridge_model)parameters->bridge_model;
    settings->liquid.contact_angle *= M_PI / 180;
    choose_bonds(parameters, settings);
    settings->n_snapshot = parameters->snapshots.count;
    settings->snapshot = parameters->snapshots.value;
    settings->threads = threads;
    const struct replay_engine *engine = replay_engine(settings);
    struct reason reason;
    const enum status status =
        engine->check ? engine->check(settings, &reason) : STATUS_OK;
    if (status) die(status, "%s", reason.text);
}
