// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of the artifact's `model`: what was modelled, with the numbers that matter, and
// what was left out. They follow the switches and nothing else, so the text cannot
// claim what was not computed. 17 digits give a double back exactly.
//
// A reader of an artifact, years later, has only this text to know the model by. So
// what is left out is named as well, each effect under the same name as where it is
// switched on. Lines are cut at the size of the buffer, never written past it.
#include "describe.h"

#include "conditions.h"
#include "dry/liquid/corner_film.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// One line, which the caller begins with "liquid: ".
const char *describe_liquid(const struct drying_conditions *conditions,
                            const struct drying_history *history, char *text,
                            size_t size)
{
    switch (conditions->liquid) {
    case LIQUID_INVISCID:
        snprintf(text, size,
                 "negligible viscosity, invasion percolation cluster by cluster");
        break;
    case LIQUID_IMMOBILE:
        snprintf(text, size, "immobile, each throat dries by itself");
        break;
    case LIQUID_VISCOUS:
        snprintf(text, size,
                 "viscous, Poiseuille flow at %.9g m2/s between moving and stationary "
                 "menisci [K 3.10], contact angle %.9g degrees; %lld clusters solved "
                 "in %lld rounds",
                 conditions->viscosity, conditions->contact_angle,
                 (long long)history->flow_solutions, (long long)history->flow_rounds);
        break;
    }
    return text;
}

// Cut at SIZE rather than past it.
static void append(char *text, size_t size, const char *more)
{
    const size_t length = strlen(text);
    snprintf(text + length, size - length, "%s", more);
}

static void describe_films(const struct drying_conditions *conditions, char *text,
                           size_t size)
{
    const struct film_conditions *films = &conditions->films;
    const double degree = M_PI / 180, half = films->half_angle * degree;
    const double angle = conditions->contact_angle * degree;
    char line[320];
    append(
        text, size,
        "rings stay at contacts as throats empty, exact bridges, and dry where films "
        "do not reach\n");
    if (corner_holds_film(half, angle))
        snprintf(line, sizeof line,
                 "films in %.6g corners of half angle %.6g degrees of each throat that "
                 "has emptied: area %.6g r^2, resistance beta %.6g, conductance times "
                 "%.6g, liquid of %.6g m2/s; flow found every %.6g of saturation\n",
                 films->corners, films->half_angle, corner_area(half, angle),
                 corner_resistance(half, angle), films->conductance,
                 conditions->viscosity, films->step);
    else
        snprintf(line, sizeof line,
                 "films: none, as half angle %.6g and contact angle make 90 degrees or "
                 "more\n",
                 films->half_angle);
    append(text, size, line);
}

// "left out" ends with what no switch turns on: the temperature field.
const char *describe_switches(const struct drying_conditions *conditions, char *text,
                              size_t size)
{
    const bool gravity = conditions->gravity != 0;
    text[0] = '\0';
    if (gravity && conditions->liquid != LIQUID_IMMOBILE)
        snprintf(text, size,
                 "gravity: %.9g m/s2, contact angle %.9g degrees; menisci at the "
                 "height of their throat's middle\n",
                 conditions->gravity, conditions->contact_angle);
    if (conditions->knudsen) {
        char line[160];
        snprintf(line, sizeof line,
                 "Knudsen effect: diffusivity halved in throats of %.6g m\n",
                 knudsen_radius(conditions));
        append(text, size, line);
    }
    if (conditions->kelvin)
        append(
            text, size,
            conditions->liquid == LIQUID_IMMOBILE
                ? "Kelvin effect: each throat's meniscus has its own vapour "
                  "pressure; vapour may condense in throats partly empty, full ones "
                  "become flatter\n"
            : conditions->liquid == LIQUID_VISCOUS
                ? "Kelvin effect: menisci that move have the vapour pressure of their "
                  "throat, those that stay that of their liquid's pressure; vapour may "
                  "condense\n"
                : "Kelvin effect: each cluster has the vapour pressure of its widest "
                  "meniscus; vapour may condense there in a throat partly empty, "
                  "full ones become flatter\n");
    if (conditions->vapour_tolerance > 0 && !(conditions->vapour_step > 0)) {
        char line[160];
        snprintf(
            line, sizeof line,
            "what wet nodes evaporate: errors add up to %.6g of the rate at most\n",
            conditions->vapour_tolerance);
        append(text, size, line);
    }
    if (conditions->vapour_step > 0) {
        char line[160];
        snprintf(
            line, sizeof line,
            "vapour found again when errors of what wet nodes evaporate may add up "
            "to %.6g of the rate\n",
            conditions->vapour_step);
        append(text, size, line);
    }
    if (conditions->rings == RINGS_ISOLATED)
        append(text, size,
               "rings stay at contacts as throats empty, exact bridges, and dry when "
               "their node has no other liquid\n");
    if (conditions->rings == RINGS_JOINED)
        append(text, size,
               "rings stay at contacts as throats empty, exact bridges; films without "
               "resistance join all liquid and feed them until the last throat has "
               "emptied\n");
    if (conditions->rings == RINGS_FILMS) describe_films(conditions, text, size);
    append(text, size, "left out: ");
    if (!gravity) append(text, size, "gravity, ");
    if (!conditions->knudsen) append(text, size, "Knudsen effect, ");
    if (!conditions->kelvin) append(text, size, "Kelvin effect, ");
    if (conditions->rings < RINGS_JOINED) append(text, size, "films, ");
    append(text, size, "temperature");
    return text;
}
