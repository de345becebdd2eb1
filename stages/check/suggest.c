// SPDX-License-Identifier: GPL-3.0-or-later
// Stiffnesses and strengths for grains of radius r, as docs/your-grains.md explains:
//
//     k_bond = E_bond/(2 r)     per area of a bond as long as a diameter
//     k = 2 E r                 a grain's, N/m: E r is that of two in series [K 4.22];
//                               at most c_k k_bond pi (f r)^2
//     p_c = c_p sigma cos(theta)/r              suction: throats scale with the grains
//     F = c_F p_c pi r^2                        the largest capillary force on a grain
//     strength = F/(pi (f r)^2)                 its stress in a neck of radius f r
//
// c_p and c_F were measured on grains that settled under gravity: 300 and 1000 equal
// ones, 400 lognormal (spread 0.3) and 400 uniform (1:4), from which they differ by a
// tenth (c_p), and from 0.7 (the largest of very unequal grains) to 1.5 (c_F).
//
// c_k is that of dem/stiff_contacts.h.
//
// Numbers are rounded to two digits: c_p and c_F are not known better. The Bond numbers
// are those of dem-replay/weight.c with these estimates in place of forces and suction,
// and without the weight of the liquid.
#include "suggest.h"

#include "dem/stiff_contacts.h"
#include "parameters/estimate.h"

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

// The stress in a neck under the largest capillary force to expect, Pa. RADIUS: of a
// grain, m. Proportional to surface tension over radius; suggest takes the median.
static double expected_stress(const struct material *material, double radius)
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
    struct packing body = *packing;
    if (!body.n_body) { // auxiliary grains beside it have room in its box
        body.lower = facts->box.lower;
        body.upper = facts->box.upper;
    }
    double volume = 0;
    for (int i = 0; i < packing->n_particle; i++)
        volume += 4 * M_PI / 3 * pow(packing->radius[i], 3);
    const double weight = material->density * GRAVITY_OF_THE_EARTH * volume;
    const double force = FORCE_OVER_SUCTION * suction * M_PI * r * r;
    return (struct bond_numbers){.grain = weight / packing->n_particle / force,
                                 .body = weight / (packing_base_area(&body) * suction)};
}

static double grain_stiffness(const struct material *material, double radius)
{
    const double bond = stiffness_of_bond(material->bond_modulus / (2 * radius),
                                          material->radius_fraction, radius);
    return fmin(2 * material->grain_modulus * radius, GRAIN_OVER_BOND * bond);
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
    const double grain = grain_stiffness(material, r);
    json_object_set_new(section, "normal_stiffness", rough(grain));
    json_object_set_new(section, "shear_stiffness", rough(grain));
    json_object_set_new(section, "bond", bond);
    const struct vector low = facts->box.lower, high = facts->box.upper;
    if (!packing->periodic[2])
        json_object_set_new(section, "held",
                            json_pack("{s:[fff],s:[fff]}", "lower", low.x, low.y,
                                      fmin(low.z, facts->lower.z), "upper", high.x,
                                      high.y, bottom_of(facts)));
    return json_pack("{s:o}", "dem-replay", section);
}

// ---- cost ---------------------------------------------------------------------------

static void add_cost(json_t *list, const char *stage, struct cost cost)
{
    json_t *row =
        json_pack("{s:s,s:o,s:o}", "stage", stage, "seconds", rough(cost.seconds),
                  "megabytes", rough(cost.mebibytes * 1.048576));
    if (cost.most > cost.least)
        json_object_set_new(row, "range",
                            json_pack("[oo]", rough(cost.least), rough(cost.most)));
    json_array_append_new(list, row);
}

json_t *expected_cost(int n)
{
    struct body_size body = body_of_grains(n);
    body.changes = recorded_changes(&body, NAN);
    body.loads = 100;
    json_t *list = json_array();
    add_cost(list, "tessellate", cost_of_tessellation(n));
    add_cost(list, "merge-nodes", cost_of_merging(&body));
    add_cost(list, "dry",
             cost_of_drying(&body, false, true,
                            default_vapour_step(body.face, body.throats)));
    add_cost(list, "force-protocol (100 loads)", cost_of_forces(&body));
    add_cost(list, "dem-replay (100 loads of 100 cycles)",
             cost_of_cycles(&body, 0, 100, 100));
    add_cost(list, "dem-replay (100 loads of 10000 cycles)", // where none comes to rest
             cost_of_cycles(&body, 0, 10000, 10000));
    add_cost(list, "dem-replay (100 equilibria, friction=0)",
             cost_of_equilibria(&body, false));
    add_cost(list, "dem-replay (100 equilibria)", cost_of_equilibria(&body, true));
    return list;
}
