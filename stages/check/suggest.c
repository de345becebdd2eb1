// SPDX-License-Identifier: GPL-3.0-or-later
// Stiffnesses and strengths for grains of radius r, as docs/your-grains.md explains:
//
//     k = 2 E r                 a grain's, N/m: E r is that of two in series [K 4.22]
//     k_bond = E_bond/(2 r)     per area of a bond as long as a diameter
//     p_c = c_p sigma cos(theta)/r              suction: throats scale with the grains
//     F = c_F p_c pi r^2                        the largest capillary force on a grain
//     strength = F/(pi (f r)^2)                 its stress in a neck of radius f r
//
// c_p and c_F were measured on grains that settled under gravity: 300 and 1000 equal
// ones, 400 lognormal (spread 0.3) and 400 uniform (1:4), from which they differ by a
// tenth (c_p), and from 0.7 (the largest of very unequal grains) to 1.5 (c_F).
//
// Numbers are rounded to two digits: c_p and c_F are not known better. The Bond numbers
// are those of dem-replay/weight.c with these estimates in place of forces and suction,
// and without the weight of the liquid.
#include "suggest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double SUCTION_OVER_TENSION = 4.6, FORCE_OVER_SUCTION = 1.4;

double bottom_of(const struct packing_facts *facts)
{
    return facts->lower.z + 1.2 * facts->ninetieth;
}

static double expected_suction(const struct material *material, double radius)
{
    const double tension =
        material->surface_tension * cos(material->contact_angle * M_PI / 180);
    return SUCTION_OVER_TENSION * tension / radius;
}

double expected_stress(const struct material *material, double radius)
{
    return FORCE_OVER_SUCTION * fabs(expected_suction(material, radius)) /
           (material->radius_fraction * material->radius_fraction);
}

struct bond_numbers expected_bond_numbers(const struct material *material,
                                          const struct packing *packing,
                                          const struct packing_facts *facts)
{
    const double r = facts->median;
    const double suction = expected_suction(material, r);
    const struct vector side = subtract(packing->upper, packing->lower);
    double volume = 0;
    for (int i = 0; i < packing->n_particle; i++)
        volume += 4 * M_PI / 3 * pow(packing->radius[i], 3);
    const double weight = material->density * GRAVITY_OF_THE_EARTH * volume;
    const double force = FORCE_OVER_SUCTION * suction * M_PI * r * r;
    return (struct bond_numbers){.grain = weight / packing->n_particle / force,
                                 .body = weight / (side.x * side.y * suction)};
}

// Two digits: more would say more than is known.
static json_t *rough(double value)
{
    char text[24];
    snprintf(text, sizeof text, "%.1e", value);
    return json_real(strtod(text, NULL));
}

json_t *suggest(const struct material *material, const struct packing *packing,
                const struct packing_facts *facts)
{
    const double r = facts->median;
    const double stress = expected_stress(material, r);
    json_t *bond = json_object();
    json_object_set_new(bond, "normal_stiffness",
                        rough(material->bond_modulus / (2 * r)));
    json_object_set_new(bond, "shear_stiffness",
                        rough(material->bond_modulus / (2 * r)));
    json_object_set_new(bond, "normal_strength", rough(stress));
    json_object_set_new(bond, "shear_strength", rough(stress));
    json_object_set_new(bond, "radius_fraction", json_real(material->radius_fraction));
    json_t *section = json_object();
    json_object_set_new(section, "density", json_real(material->density));
    json_object_set_new(section, "normal_stiffness",
                        rough(2 * material->grain_modulus * r));
    json_object_set_new(section, "shear_stiffness",
                        rough(2 * material->grain_modulus * r));
    json_object_set_new(section, "bond", bond);
    const struct vector low = packing->lower, high = packing->upper;
    if (!packing->periodic[2])
        json_object_set_new(section, "held",
                            json_pack("{s:[fff],s:[fff]}", "lower", low.x, low.y,
                                      fmin(low.z, facts->lower.z), "upper", high.x,
                                      high.y, bottom_of(facts)));
    return json_pack("{s:o}", "dem-replay", section);
}

// ---- cost ---------------------------------------------------------------------------

// Seconds of one core and megabytes of A n^B for n thousand grains: between 1000
// settled grains with the scene of docs/your-grains.md and the 100,000 of
// tests/bench/scale; equilibria at 1000 and 4000 grains without friction, and at 200
// and 300 with friction and some twenty cracks. Never less memory than at 1000.
static const struct rate {
    const char *stage;
    double seconds, seconds_power, megabytes, megabytes_power;
} rates[] = {{"tessellate", 0.1, 0.8, 15, 0.5},
             {"merge-nodes", 0.05, 0.7, 15, 0.7},
             {"dry", 0.6, 1.5, 40, 0.5},
             {"force-protocol (100 loads)", 1, 0.8, 63, 0.6},
             {"dem-replay (100 loads of 100 cycles)", 1.5, 0.9, 21, 1},
             {"dem-replay (100 equilibria, friction=0)", 4, 3, 61, 1.3},
             {"dem-replay (100 equilibria)", 400, 3, 61, 1.3}};

json_t *expected_cost(int n)
{
    json_t *list = json_array();
    for (size_t k = 0; k < sizeof rates / sizeof *rates; k++) {
        const struct rate *rate = &rates[k];
        const double thousands = n / 1000.0;
        const double megabytes =
            rate->megabytes * pow(fmax(thousands, 1), rate->megabytes_power);
        json_array_append_new(
            list, json_pack("{s:s,s:o,s:o}", "stage", rate->stage, "seconds",
                            rough(rate->seconds * pow(thousands, rate->seconds_power)),
                            "megabytes", rough(megabytes)));
    }
    return list;
}
