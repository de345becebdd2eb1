// SPDX-License-Identifier: GPL-3.0-or-later
// One table gives each member its attribute in the group /liquid; reading, writing and
// comparing go by it or by the two that another stage needs: surface tension and
// contact angle.
//
//     /liquid        temperature (K), surface_tension (N/m), contact_angle (degrees),
//                    density (kg/m3), viscosity (m2/s), molar_mass (kg/mol)
//
// A property that is not known is NAN in memory and left out of the file, so that a
// number in a file was known to whoever wrote it.
#include "artifacts/liquid.h"

#include "basics/status.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    size_t offset;
} members[] = {
    {"/liquid/temperature", offsetof(struct liquid_properties, temperature)},
    {"/liquid/surface_tension", offsetof(struct liquid_properties, surface_tension)},
    {"/liquid/contact_angle", offsetof(struct liquid_properties, contact_angle)},
    {"/liquid/density", offsetof(struct liquid_properties, density)},
    {"/liquid/viscosity", offsetof(struct liquid_properties, viscosity)},
    {"/liquid/molar_mass", offsetof(struct liquid_properties, molar_mass)},
};
enum { MEMBERS = sizeof members / sizeof *members };

struct liquid_properties liquid_of(const struct conditions *conditions)
{
    const double *property = conditions->property;
    return (struct liquid_properties){.temperature = conditions->temperature,
                                      .surface_tension =
                                          property[FLUID_SURFACE_TENSION],
                                      .contact_angle = conditions->contact_angle,
                                      .density = property[FLUID_DENSITY],
                                      .viscosity = property[FLUID_VISCOSITY],
                                      .molar_mass = property[FLUID_MOLAR_MASS]};
}

// NAN also where the schema of ARTIFACT has no such attribute.
struct liquid_properties artifact_get_liquid(const struct artifact *artifact)
{
    struct liquid_properties liquid;
    for (int k = 0; k < MEMBERS; k++)
        *(double *)((char *)&liquid + members[k].offset) =
            artifact_has_number(artifact, members[k].name)
                ? artifact_get_number(artifact, members[k].name)
                : (double)NAN;
    return liquid;
}

void artifact_put_liquid(struct artifact *artifact,
                         const struct liquid_properties *liquid)
{
    for (int k = 0; k < MEMBERS; k++) {
        const double value =
            *(const double *)((const char *)liquid + members[k].offset);
        if (!isnan(value)) artifact_put_number(artifact, members[k].name, value);
    }
}

void refuse_saturation(const struct artifact *artifact, const char *advice)
{
    static const char name[] = "/throats/saturation";
    if (!strcmp(artifact->schema->name, "network") &&
        artifact_has_dataset(artifact, name))
        die(STATUS_BAD_DATA, "%s: %s: %s", input_name(artifact->path), name, advice);
}

void liquid_complete(struct liquid_properties *told,
                     const struct liquid_properties *has)
{
    if (isnan(told->surface_tension)) told->surface_tension = has->surface_tension;
    if (isnan(told->contact_angle)) told->contact_angle = has->contact_angle;
}

// A thousandth of the larger: digits lost in printing do not count. False where one is
// NAN.
static bool differ(double one, double other)
{
    return fabs(one - other) > 1e-3 * fmax(fabs(one), fabs(other));
}

static void append_difference(char *text, size_t size, const char *what, double told,
                              double has, const char *unit, const char *name)
{
    if (!differ(told, has)) return;
    const size_t length = strlen(text);
    snprintf(text + length, size - length, "%s%s = %.6g %s, but that of %s is %.6g",
             length ? "; " : "", what, told, unit, name, has);
}

bool liquid_differs(const struct liquid_properties *told,
                    const struct liquid_properties *has, const char *name, char *text,
                    size_t size)
{
    text[0] = '\0';
    append_difference(text, size, "surface_tension", told->surface_tension,
                      has->surface_tension, "N/m", name);
    append_difference(text, size, "contact_angle", told->contact_angle,
                      has->contact_angle, "degrees", name);
    return text[0] != '\0';
}
