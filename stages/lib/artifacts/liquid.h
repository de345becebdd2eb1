// SPDX-License-Identifier: GPL-3.0-or-later
// The liquid in an artifact, attributes of the group /liquid: what the drying was told
// goes along to the stages behind it, so that a user says it once. Each attribute may
// be missing.
#pragma once

#include "artifacts/artifact.h"
#include "parameters/conditions.h"

#include <stdbool.h>

// In the units of the schemas, all above 0 but the angle; NAN: not known. A value:
// nothing to free.
struct liquid_properties {
    double temperature;     // K
    double surface_tension; // N/m
    double contact_angle;   // degrees
    double density;         // kg/m3
    double viscosity;       // kinematic, m2/s
    double molar_mass;      // kg/mol
};

// The properties in CONDITIONS, which conditions_complete has completed.
struct liquid_properties liquid_of(const struct conditions *conditions);

// Reads those that ARTIFACT has, the others are NAN; writes those that are known. What
// stages behind the drying use unless told otherwise.
struct liquid_properties artifact_get_liquid(const struct artifact *artifact);
void artifact_put_liquid(struct artifact *artifact,
                         const struct liquid_properties *liquid);

// Exits 65 at a network that says how full its throats are (/throats/saturation);
// ADVICE says why, and what to give instead.
void refuse_saturation(const struct artifact *artifact, const char *advice);

// Gives TOLD the surface tension and contact angle of HAS where they are not known.
// What neither knows stays NAN: the caller says what must be given. Only these two: a
// stage behind the drying needs no more for its menisci.
void liquid_complete(struct liquid_properties *told,
                     const struct liquid_properties *has);

// Whether surface tension or contact angle differ by more than a thousandth, where both
// know them; then TEXT (SIZE bytes) says so in one line: "surface_tension = 0.0727 N/m,
// but that of NAME is 0.0223". It is empty where they do not differ. To warn, not to
// refuse: a user may want to vary one number.
bool liquid_differs(const struct liquid_properties *told,
                    const struct liquid_properties *has, const char *name, char *text,
                    size_t size);
