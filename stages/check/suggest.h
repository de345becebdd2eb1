// SPDX-License-Identifier: GPL-3.0-or-later
// Parameters of dem-replay to start with for grains of this size, and what a run
// costs.
#pragma once

#include "geometry/bond_numbers.h"
#include "geometry/packing_check.h"

#include <jansson.h>

// What the user says of grains, bonds and liquid.
struct material {
    double density;         // kg/m3
    double grain_modulus;   // Young's modulus, Pa
    double bond_modulus;    // of the bonds, Pa
    double radius_fraction; // of a bond, of the smaller grain's
    double surface_tension; // N/m
    double contact_angle;   // degrees
};

// The height (m) below which the centres of the lowest grains lie, which should be
// held. 1.2 of the ninth decile of radii above the lowest grain.
double bottom_of(const struct packing_facts *facts);

// With the gravity of the Earth and the largest capillary force to expect on a grain.
struct bond_numbers expected_bond_numbers(const struct material *material,
                                          const struct packing *packing,
                                          const struct packing_facts *facts);

// {"dem-replay": {...}}: density, stiffnesses and strengths for grains of the median
// radius, rounded to two digits, and the region of grains to hold (not in a box that
// repeats along z). A section that dem-replay reads as it is. The caller owns it.
json_t *suggest(const struct material *material, const struct packing *packing,
                const struct packing_facts *facts);

// [{"stage": ..., "seconds": ..., "megabytes": ...}, ...] for N grains on one core, by
// costs/costs.h: what --estimate of these stages says. The caller owns it.
json_t *expected_cost(int n);
