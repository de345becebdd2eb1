// SPDX-License-Identifier: GPL-3.0-or-later
// Kelvin's law: the vapour above a curved meniscus.
//
// The potential -ln(1 - p_v/p_g), scaled to 0 above a flat meniscus and 1 in the drying
// air, rises with the exponent p_c M / (rho R T) by which the vapour pressure falls.
//
// With x the exponent, p_v = p_sat exp(-x) and
//     potential(x) = ln(1 + p_sat (1 - exp(-x)) / (p_g - p_sat)) / drop,
//     drop = ln(1 + (p_sat - p_inf) / (p_g - p_sat)).
// Below 0 a meniscus bulges, and its vapour is above saturation. In wide throats x is
// tiny: log1p and expm1 keep its digits.
#pragma once

#include "dry/conditions.h"

struct kelvin_law {
    double air_pressure, saturation; // p_g - p_sat, p_sat, Pa
    double drop;                     // of -ln(1 - p_v/p_g) from flat menisci to the air
    double exponent;                 // of a throat 1 m in radius
    double exponent_per_pressure;    // of 1 Pa
    double exponent_per_height;      // rise of the exponent a metre upwards, 1/m
};

// The law for the liquid, the gas and the temperature of CONDITIONS.
struct kelvin_law kelvin_law(const struct drying_conditions *conditions);

// The potential above a meniscus of given exponent p_c M / (rho R T), its derivative by
// the exponent, and the inverse of the first.
double kelvin_potential(const struct kelvin_law *law, double exponent);
double kelvin_slope(const struct kelvin_law *law, double exponent);
double kelvin_exponent_at(const struct kelvin_law *law, double potential);

// The exponent of the most bulging meniscus that is tried (below 0): its vapour leaves
// half of the air that there is above a flat one.
double kelvin_least_exponent(const struct kelvin_law *law);

// STATUS_BAD_DATA with a throat whose meniscus has no higher vapour pressure than the
// drying air: it never dries. STATUS_OK without the Kelvin effect.
enum status check_kelvin(const struct drying_conditions *conditions,
                         const struct network *network, struct reason *reason);
