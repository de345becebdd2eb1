// SPDX-License-Identifier: GPL-3.0-or-later
// What is given stands; what is not comes from lib/fluids for the named liquid at the
// temperature; air_vapour_pressure comes last, as relative_humidity needs the
// saturation pressure:
//     air_vapour_pressure = relative_humidity * saturation_pressure.
//
// Order matters twice. conditions_share copies what the scene says into the section
// before the table fills the struct, so a stage cannot tell the two apart;
// conditions_complete notes in `given` what was given before it fills in the rest, so
// that conditions_describe and conditions_note can tell the user what is not the
// liquid's own.
#include "parameters/conditions.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// All keys that the section "conditions" may have.
static const struct parameter conditions_table[] = {FLUID_ROWS(0),
                                                    VAPOUR_ROWS(0),
                                                    LIQUID_DENSITY_ROW(0),
                                                    VISCOSITY_ROW(0),
                                                    SURFACE_TENSION_ROW(0),
                                                    CONTACT_ANGLE_ROW(0, 170),
                                                    {0}};

// In the order of enum fluid_property.
static const struct {
    const char *key, *words, *unit;
} properties[FLUID_PROPERTIES] = {
    {"saturation_pressure", "saturation pressure", "Pa"},
    {"diffusivity", "diffusivity in air", "m2/s"},
    {"molar_mass", "molar mass", "kg/mol"},
    {"liquid_density", "density", "kg/m3"},
    {"viscosity", "viscosity", "m2/s"},
    {"surface_tension", "surface tension", "N/m"},
};

struct conditions conditions_unset(void)
{
    struct conditions unset = {.temperature = NAN,
                               .gas_pressure = 1e5,
                               .relative_humidity = NAN,
                               .air_vapour_pressure = NAN};
    for (int k = 0; k < FLUID_PROPERTIES; k++)
        unset.property[k] = NAN;
    return unset;
}

// The section is checked by its own table first, so that a typing error there is found
// even if no stage needs the key.
void conditions_share(json_t *section, const struct parameter *table,
                      const json_t *conditions, const char *where)
{
    if (!conditions) return;
    struct conditions checked;
    json_decref(parameters_fill(conditions_table, conditions, where, &checked));
    for (const struct parameter *p = table; p->key; p++)
        if (p->shared) parameters_give(section, p->key, conditions);
}

static bool is_named(const struct conditions *conditions)
{
    return conditions->fluid != FLUID_OTHER;
}

// NAN where it is not known, of this liquid or at this temperature.
static double own_value(const struct conditions *conditions, int property)
{
    return fluid_value((enum fluid)conditions->fluid, (enum fluid_property)property,
                       conditions->temperature, conditions->gas_pressure);
}

// Three reasons, and what to do about each: no liquid named, a property that is not
// tabulated, a temperature outside of the table.
static enum status refuse_unknown(const struct conditions *conditions, int property,
                                  struct reason *reason)
{
    const enum fluid fluid = (enum fluid)conditions->fluid;
    const struct fluid_range range = fluid_range(fluid, (enum fluid_property)property);
    const char *key = properties[property].key;
    if (!is_named(conditions))
        return refuse(
            reason, STATUS_BAD_DATA,
            "%s: must be given in %s: with fluid=other nothing is known of it", key,
            properties[property].unit);
    if (range.from > range.to)
        return refuse(
            reason, STATUS_BAD_DATA,
            "%s: must be given in %s: that of %s is not known here (docs/fluids.md)",
            key, properties[property].unit, fluid_name(fluid));
    return refuse(reason, STATUS_BAD_DATA,
                  "temperature: must be from %g to %g K, where the %s of %s is known, "
                  "is %g; or give %s in %s",
                  range.from, range.to, properties[property].words, fluid_name(fluid),
                  conditions->temperature, key, properties[property].unit);
}

// Air takes up other vapours whatever its humidity. Humidity is a share of the
// saturation pressure of water, so it says nothing of other vapours. Both given would
// contradict each other.
static enum status complete_air(struct conditions *conditions, struct reason *reason)
{
    const double humidity = conditions->relative_humidity;
    if (isnan(humidity)) {
        if (isnan(conditions->air_vapour_pressure)) conditions->air_vapour_pressure = 0;
        return STATUS_OK;
    }
    if (conditions->fluid != FLUID_WATER && is_named(conditions))
        return refuse(
            reason, STATUS_BAD_DATA,
            "relative_humidity: is that of water vapour, but the liquid is %s: give "
            "the pressure of its vapour in the air, air_vapour_pressure, or leave both "
            "out for air without any",
            fluid_name((enum fluid)conditions->fluid));
    if (!isnan(conditions->air_vapour_pressure))
        return refuse(reason, STATUS_BAD_DATA,
                      "relative_humidity: must be null where air_vapour_pressure is "
                      "given, got %g beside %g Pa",
                      humidity, conditions->air_vapour_pressure);
    conditions->air_vapour_pressure =
        humidity * conditions->property[FLUID_SATURATION_PRESSURE];
    return STATUS_OK;
}

// A temperature below 200 was meant in degrees Celsius.
enum status conditions_complete(struct conditions *conditions, unsigned needed,
                                struct reason *reason)
{
    if (conditions->temperature < 200)
        return refuse(reason, STATUS_BAD_DATA,
                      "temperature: %g K? temperatures are in kelvin: %g is %g degrees "
                      "Celsius",
                      conditions->temperature, conditions->temperature + 273.15,
                      conditions->temperature);
    conditions->given = 0;
    for (int k = 0; k < FLUID_PROPERTIES; k++) {
        if (!isnan(conditions->property[k]))
            conditions->given |= 1u << k;
        else
            conditions->property[k] = own_value(conditions, k);
        if (isnan(conditions->property[k]) && needed >> k & 1)
            return refuse_unknown(conditions, k, reason);
    }
    return complete_air(conditions, reason);
}

// The message begins with "STAGE.KEY", as those of parameters_fill do.
void conditions_require(struct conditions *conditions, unsigned needed,
                        const char *stage)
{
    struct reason reason;
    const enum status status = conditions_complete(conditions, needed, &reason);
    if (status) die(status, "%s.%s", stage, reason.text);
}

// Cut where TEXT is full; never beyond SIZE.
static void append(char *text, size_t size, const char *more)
{
    const size_t length = strlen(text);
    snprintf(text + length, size - length, "%s", more);
}

// A given value is shown beside the liquid's own, so that a reader sees what was
// changed.
const char *conditions_describe(const struct conditions *conditions, unsigned shown,
                                char *text, size_t size)
{
    const char *name = fluid_name((enum fluid)conditions->fluid);
    snprintf(text, size, "fluid: %s at %g K", is_named(conditions) ? name : "one given",
             conditions->temperature);
    for (int k = 0; k < FLUID_PROPERTIES; k++) {
        const double value = conditions->property[k], own = own_value(conditions, k);
        if (!(shown >> k & 1) || isnan(value)) continue;
        char more[160], given[60] = "";
        if (conditions->given >> k & 1 && is_named(conditions)) {
            if (isnan(own))
                snprintf(given, sizeof given, " (given)");
            else
                snprintf(given, sizeof given, " (given; %s has %.6g)", name, own);
        }
        snprintf(more, sizeof more, ", %s %.6g %s%s", properties[k].words, value,
                 properties[k].unit, given);
        append(text, size, more);
    }
    return text;
}

// More than a tenth: tables of one liquid differ by less.
void conditions_note(const struct conditions *conditions, unsigned needed)
{
    const char *name = fluid_name((enum fluid)conditions->fluid);
    for (int k = 0; k < FLUID_PROPERTIES; k++) {
        const double value = conditions->property[k], own = own_value(conditions, k);
        if (!(conditions->given >> k & 1) || !(needed >> k & 1)) continue;
        if (!(fabs(value - own) > 0.1 * own)) continue; // nor where none is known
        report("%s = %.6g %s was given, but %s at %g K has %.6g: null uses that value, "
               "fluid=other is for another liquid",
               properties[k].key, value, properties[k].unit, name,
               conditions->temperature, own);
    }
}
