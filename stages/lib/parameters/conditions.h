// SPDX-License-Identifier: GPL-3.0-or-later
// What a body dries of and in: the liquid, the air, the temperature. A scene says it
// once, in its section "conditions"; a stage whose own section says nothing else takes
// it from there. What neither gives is that of the named liquid at the temperature. The
// macros below are rows of tables: written once, so that a key has the same unit,
// default and help in each stage that takes it.
//
// The order of calls matters: stage_begin (which calls conditions_share) fills the
// struct, then conditions_complete or _require, once, before any property is read;
// _describe and _note go by `given`, which that call sets.
#pragma once

#include "basics/status.h"
#include "fluids/fluids.h"
#include "parameters/parameters.h"

// Life of one: a stage's table fills it by the rows below, NAN where a user gave
// nothing; conditions_complete fills in the rest; conditions_describe and _note tell
// the user what holds. A value: nothing to free.
struct conditions {
    int fluid;            // enum fluid
    double temperature;   // K
    double gas_pressure;  // Pa
    double contact_angle; // degrees
    // NAN: not given.
    double relative_humidity; // share of saturation of water vapour in the air, 0 to 1
    double air_vapour_pressure;        // of the liquid's vapour in the air, Pa
    double property[FLUID_PROPERTIES]; // by enum fluid_property, in its units
    unsigned given; // bit k: property k was given, and is not the liquid's by its name
};

// Nothing given: for a stage whose table has not all the rows. The gas is at 1e5 Pa.
struct conditions conditions_unset(void);

// Checks the section, NULL where a scene has none, and gives SECTION, a stage's own by
// TABLE, what it lacks of the rows that are shared. Exits 65 as parameters_fill, with
// WHERE in its messages.
void conditions_share(json_t *section, const struct parameter *table,
                      const json_t *conditions, const char *where);

// Fills in the properties that were not given, and the vapour in the air (0 where
// neither it nor the humidity was). One that is not known stays NAN. STATUS_BAD_DATA,
// with the key: a temperature below 200 K; a property with its bit in NEEDED that is
// not known, or not at this temperature; humidity of another liquid than water, or
// beside the vapour pressure. NEEDED has bit k for property k (enum fluid_property).
// What was given stands, whatever the liquid; its bit is then set in `given`. Reads no
// file and prints nothing.
enum status conditions_complete(struct conditions *conditions, unsigned needed,
                                struct reason *reason);

// The same, or exits 65 with one line: STAGE, the key, and what to give.
void conditions_require(struct conditions *conditions, unsigned needed,
                        const char *stage);

// One line into TEXT (SIZE bytes), which is returned: the liquid by name, temperature,
// and those properties with their bit in SHOWN; beside a given one also the liquid's
// own. For the model text of artifacts: what the drying was done with, by name. The
// text is cut at SIZE.
const char *conditions_describe(const struct conditions *conditions, unsigned shown,
                                char *text, size_t size);

// On stderr, what was given and is more than a tenth off what the named liquid has:
// such as a saturation pressure that stays when the temperature is changed.
void conditions_note(const struct conditions *conditions, unsigned needed);

// ---- rows of a stage's table --------------------------------------------------------

// A stage takes those rows whose quantities it needs; all are `shared`, so a scene may
// give them once. AT is where struct conditions lies in the stage's parameter struct;
// MOST is the largest contact angle, degrees, that its model can take.
//
//     macro                key                  unit      where it is null
//     FLUID_ROWS           fluid                choice    never: "water"
//                          temperature          K         never: 293.15
//     VAPOUR_ROWS          gas_pressure         Pa        never: 1e5
//                          saturation_pressure  Pa        the fluid's
//                          relative_humidity    1         air_vapour_pressure holds
//                          air_vapour_pressure  Pa        by relative_humidity, else 0
//                          diffusivity          m2 s-1    the fluid's, in air
//                          molar_mass           kg mol-1  the fluid's
//     LIQUID_DENSITY_ROW   liquid_density       kg m-3    the fluid's
//     VISCOSITY_ROW        viscosity            m2 s-1    the fluid's, kinematic
//     SURFACE_TENSION_ROW  surface_tension      N m-1     the fluid's
//     CONTACT_ANGLE_ROW    contact_angle        degree    never: 0
//
// A stage that leaves a macro out must begin its struct with conditions_unset: no row
// fills those members then. FLUID_ROWS is the one that every stage with conditions
// needs, for without liquid and temperature nothing can be looked up. An angle of 90
// degrees or more leaves no suction: stages that need one take less. What a scene says
// of a key that no row of the stage has is checked, too, and then left alone.
#define CONDITION_AT(at, member) (at) + offsetof(struct conditions, member)
// clang-format off
#define FLUID_ROWS(at) \
    {"fluid", PARAMETER_CHOICE, "1", "\"water\"", CONDITION_AT(at, fluid), \
     .choices = FLUID_CHOICES, .shared = true, \
     .text = "liquid: properties that are null are its own at the temperature " \
             "(docs/fluids.md); other: all that are needed must be given"}, \
    {"temperature", PARAMETER_NUMBER, "K", "293.15", CONDITION_AT(at, temperature), \
     ABOVE(0), .shared = true, .text = "temperature, the same everywhere"}
#define VAPOUR_ROWS(at) \
    {"gas_pressure", PARAMETER_NUMBER, "Pa", "1e5", CONDITION_AT(at, gas_pressure), \
     ABOVE(0), .shared = true, .text = "pressure of the gas"}, \
    {"saturation_pressure", PARAMETER_NUMBER, "Pa", "null", \
     CONDITION_AT(at, property[FLUID_SATURATION_PRESSURE]), ABOVE(0), .shared = true, \
     .text = "equilibrium vapour pressure; null: the fluid's"}, \
    {"relative_humidity", PARAMETER_NUMBER, "1", "null", \
     CONDITION_AT(at, relative_humidity), BETWEEN(0, 1), .shared = true, \
     .text = "of the drying air, of saturation, where the liquid is water; null: as " \
             "air_vapour_pressure says"}, \
    {"air_vapour_pressure", PARAMETER_NUMBER, "Pa", "null", \
     CONDITION_AT(at, air_vapour_pressure), AT_LEAST(0), .shared = true, \
     .text = "pressure of the liquid's vapour in the drying air; null: as " \
             "relative_humidity says, else 0"}, \
    {"diffusivity", PARAMETER_NUMBER, "m2 s-1", "null", \
     CONDITION_AT(at, property[FLUID_DIFFUSIVITY]), ABOVE(0), .shared = true, \
     .text = "of vapour in the gas; null: the fluid's in air of gas_pressure"}, \
    {"molar_mass", PARAMETER_NUMBER, "kg mol-1", "null", \
     CONDITION_AT(at, property[FLUID_MOLAR_MASS]), ABOVE(0), .shared = true, \
     .text = "of the liquid; null: the fluid's"}
#define LIQUID_DENSITY_ROW(at) \
    {"liquid_density", PARAMETER_NUMBER, "kg m-3", "null", \
     CONDITION_AT(at, property[FLUID_DENSITY]), ABOVE(0), .shared = true, \
     .text = "of the liquid, above that of the gas; null: the fluid's"}
#define VISCOSITY_ROW(at) \
    {"viscosity", PARAMETER_NUMBER, "m2 s-1", "null", \
     CONDITION_AT(at, property[FLUID_VISCOSITY]), ABOVE(0), .shared = true, \
     .text = "kinematic, of viscous liquid; null: the fluid's"}
#define SURFACE_TENSION_ROW(at) \
    {"surface_tension", PARAMETER_NUMBER, "N m-1", "null", \
     CONDITION_AT(at, property[FLUID_SURFACE_TENSION]), ABOVE(0), .shared = true, \
     .text = "of the liquid against the gas; null: the fluid's"}
#define CONTACT_ANGLE_ROW(at, most) \
    {"contact_angle", PARAMETER_NUMBER, "degree", "0", \
     CONDITION_AT(at, contact_angle), BETWEEN(0, most), .shared = true, \
     .text = "imperfect wetting: the capillary pressure is 2 surface_tension " \
             "cos(this) / r"}
// clang-format on
