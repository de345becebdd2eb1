// SPDX-License-Identifier: GPL-3.0-or-later
// The liquid in an artifact, /liquid: what the drying was told goes along to whoever
// has need of it, so that it is said once.
#ifndef CRAQUELURE_ARTIFACT_LIQUID_H
#define CRAQUELURE_ARTIFACT_LIQUID_H

#include "artifacts/artifact.h"
#include "parameters/conditions.h"

#include <stdbool.h>

// In the units of the schemas, all above 0 but the angle; NAN: not known.
struct liquid_properties {
    double temperature;     // K
    double surface_tension; // N/m
    double contact_angle;   // degrees
    double density;         // kg/m3
    double viscosity;       // kinematic, m2/s
    double molar_mass;      // kg/mol
};

// Of conditions that are complete.
struct liquid_properties liquid_of(const struct conditions *conditions);

// Those that ARTIFACT has, the others NAN; and writes those that are known.
struct liquid_properties artifact_get_liquid(const struct artifact *artifact);
void artifact_put_liquid(struct artifact *artifact,
                         const struct liquid_properties *liquid);

// Gives TOLD the surface tension and contact angle of HAS where they are not known.
void liquid_complete(struct liquid_properties *told,
                     const struct liquid_properties *has);

// Whether surface tension or contact angle differ by more than a thousandth, where both
// know them; then TEXT says so in one line: "surface_tension = 0.0727 N/m, but that of
// NAME is 0.0223".
bool liquid_differs(const struct liquid_properties *told,
                    const struct liquid_properties *has, const char *name, char *text,
                    size_t size);

#endif
