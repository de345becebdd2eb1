// SPDX-License-Identifier: GPL-3.0-or-later
// Kelvin's law, p_v = p_sat exp(-x), where the exponent x = p_c M / (rho R T), as a
// potential of the vapour that is 0 above a flat meniscus and 1 in the drying air:
//     potential(x) = ln(1 + p_sat (1 - e^-x) / (p_g - p_sat)) / drop,
//     drop = ln(1 + (p_sat - p_inf) / (p_g - p_sat)),
//     slope = p_sat e^-x / ((p_g - p_sat + p_sat (1 - e^-x)) drop).
// Under gravity x rises by g M / (R T) per metre of height. In wide throats x is tiny:
// log1p and expm1 keep the digits of the potential, which would else be 1 - 1.
#include "kelvin_law.h"

#include <math.h>

struct kelvin_law kelvin_law(const struct drying_conditions *conditions)
{
    const double heat = GAS_CONSTANT * conditions->temperature / conditions->molar_mass;
    const double air_pressure =
        conditions->gas_pressure - conditions->saturation_pressure;
    const double tension =
        2 * conditions->surface_tension * cos(conditions->contact_angle * (M_PI / 180));
    return (struct kelvin_law){
        .air_pressure = air_pressure,
        .saturation = conditions->saturation_pressure,
        .drop =
            log1p((conditions->saturation_pressure - conditions->air_vapour_pressure) /
                  air_pressure),
        .exponent = tension / (conditions->liquid_density * heat),
        .exponent_per_pressure = 1 / (conditions->liquid_density * heat),
        .exponent_per_height =
            conditions->liquid == LIQUID_IMMOBILE ? 0 : conditions->gravity / heat};
}

double kelvin_potential(const struct kelvin_law *law, double exponent)
{
    return log1p(-law->saturation * expm1(-exponent) / law->air_pressure) / law->drop;
}

double kelvin_slope(const struct kelvin_law *law, double exponent)
{
    const double gas = law->air_pressure - law->saturation * expm1(-exponent);
    return law->saturation * exp(-exponent) / gas / law->drop;
}

double kelvin_exponent_at(const struct kelvin_law *law, double potential)
{
    return -log1p(-expm1(potential * law->drop) * law->air_pressure / law->saturation);
}

double kelvin_least_exponent(const struct kelvin_law *law)
{
    return -log1p(law->air_pressure / law->saturation / 2);
}

enum status check_kelvin(const struct drying_conditions *conditions,
                         const struct network *network, struct reason *reason)
{
    const struct kelvin_law law = kelvin_law(conditions);
    for (int t = 0; conditions->kelvin && t < network->n_throat; t++)
        if (network->throat_kind[t] == THROAT_NETWORK &&
            !(kelvin_potential(&law, law.exponent / network->throat_radius[t]) < 1))
            return refuse(reason, STATUS_BAD_DATA,
                          "kelvin: the throat of /throats/radius row %d, %g m, never "
                          "dries: its meniscus has no more vapour than the air",
                          t, network->throat_radius[t]);
    return STATUS_OK;
}
