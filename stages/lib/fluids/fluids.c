// SPDX-License-Identifier: GPL-3.0-or-later
// Water has equations of its own (water.c); the other liquids have
//   saturation pressure  log10(p/Pa) = A - B/(T + C)
//   density              rho = rho_c + a theta^0.35 + b theta^(2/3) + c theta
//                              + d theta^(4/3),    theta = 1 - T/Tc
//   dynamic viscosity    mu = e exp(a x^(1/3) + b x^(4/3)),  x = (c - T)/(T - d)
//   surface tension      sigma = a theta^(b + c t + d t^2 + e t^3),  t = T/Tc
// and all of them, with sums v of diffusion volumes and M_ab = 2/(1/M + 1/M_air) in
// g/mol, p in bar,
//   diffusivity          D = 1.43e-7 m2/s T^1.75 / (p M_ab^(1/2) (v^(1/3) +
//                            v_air^(1/3))^2)
#include "fluids/fluids.h"

#include "fluids/water.h"

#include <math.h>

// SR6-08 ends at 383.15 K. Saturation pressure and surface tension begin at the triple
// point, 0.01 K above.
static const struct fluid_range water_range = {273.15, 383.15};
// The PPDS equations hold from the melting to near the critical point; this part of
// their range was compared with other sources.
static const struct fluid_range ppds_range = {263.15, 383.15};
static const struct fluid_range diffusivity_range = {200, 600};
static const struct fluid_range unknown = {0, -1};

struct liquid {
    const char *name;
    double molar_mass;       // kg/mol
    double diffusion_volume; // Fuller's, of the molecule
    double antoine[3];
    struct fluid_range antoine_range;
    double critical_temperature; // K; 0: no PPDS equations
    double density[5];           // kg/m3, the first of the critical point
    double viscosity[5];         // the last in Pa s
    double surface_tension[5];   // the first in N/m
};

// clang-format off
static const struct liquid liquids[FLUID_COUNT] = {
    [FLUID_WATER] = {"water", 18.015268e-3, 13.1, {0}, {0, 0}, 0, {0}, {0}, {0}},
    [FLUID_METHANOL] = {"methanol", 32.042e-3, 31.25,
        {10.20277, 1580.08, -33.65}, {262.59, 356}, 513.38,
        {282, 164.7611, 2257.7678, -3545.6923, 1929.7376},
        {3.79226, 0.17755, 546.563, 87.845, 7.91e-6},
        {0.04372, 0.8646, -0.07327, -0.51872, 0.66269}},
    [FLUID_ETHANOL] = {"ethanol", 46.068e-3, 51.77,
        {10.33675, 1648.22, -42.232}, {276.5, 369.54}, 513.9,
        {276, 748.617, -412.3622, 776.4394, -436.6757},
        {6.16832, -0.00125, 740.323, 90.778, 0.38e-6},
        {0.06165, 2.37635, -3.15086, 1.98424, -0.15806}},
    [FLUID_ISOPROPANOL] = {"isopropanol", 60.095e-3, 72.29,
        {10.24268, 1580.92, -53.54}, {281.28, 373.46}, 508.25,
        {273, 865.9165, -744.0943, 975.9052, -381.1278},
        {3.07172, 3.84587, 580.414, -62.691, 7.42e-6},
        {0.04172, 0.77686, 0, 0, 0}},
    [FLUID_ACETONE] = {"acetone", 58.079e-3, 67.67,
        {9.2184, 1197.01, -45.09}, {247.38, 350.65}, 508.1,
        {274, 547.382, 208.742, -203.7599, 253.9936},
        {1.65496, 0.5733, 610.687, 11.477, 29.15e-6},
        {0.06223, 1.12463, 0, 0, 0}},
    [FLUID_ETHYL_ACETATE] = {"ethyl-acetate", 88.105e-3, 94.3,
        {9.13361, 1195.13, -60.68}, {265.5, 372.51}, 523.2,
        {308, 660.3752, 8.8513, 207.168, 1.5101},
        {2.87505, 3.82999, 701.624, -475.816, 8.53e-6},
        {0.05977, 1.11993, 0, 0, 0}},
    [FLUID_HEXANE] = {"n-hexane", 86.175e-3, 127.74,
        {9.00139, 1170.875, -48.833}, {254.24, 365.25}, 507.79,
        {223, 537.394, 87.8728, -283.3888, 344.5049},
        {0.69508, 0.53665, 704.295, 16.747, 56.57e-6},
        {0.055, 1.26769, 0, 0, 0}},
    [FLUID_HEPTANE] = {"n-heptane", 100.202e-3, 148.26,
        {9.02023, 1263.909, -56.718}, {277.71, 396.53}, 541.23,
        {225, 308.4582, 1071.686, -1664.6321, 990.254},
        {2.96002, 0.24715, 553.942, 62.172, 14.24e-6},
        {0.05422, 1.25287, 0, 0, 0}},
    [FLUID_TOLUENE] = {"toluene", 92.138e-3, 111.48,
        {9.05043, 1327.62, -55.525}, {286.44, 409.61}, 591.75,
        {292, 439.5835, 839.1558, -1234.8445, 797.8741},
        {2.9548, 0.00003, 1048.107, 137.144, 3.97e-6},
        {0.06676, 1.24386, 0, 0, 0}},
    [FLUID_NMP] = {"nmp", 99.131e-3, 92.64,
        {9.18002, 1655.29, -80.355}, {336, 477}, 0, {0}, {0}, {0}},
    [FLUID_OTHER] = {"other", NAN, NAN, {0}, {0, -1}, 0, {0}, {0}, {0}},
};
// clang-format on

const char *fluid_name(enum fluid fluid)
{
    return liquids[fluid].name;
}

struct fluid_range fluid_range(enum fluid fluid, enum fluid_property property)
{
    static const struct fluid_range always = {0, INFINITY};
    if (fluid == FLUID_OTHER) return unknown;
    if (property == FLUID_MOLAR_MASS) return always;
    if (property == FLUID_DIFFUSIVITY) return diffusivity_range;
    if (fluid == FLUID_WATER) return water_range;
    if (property == FLUID_SATURATION_PRESSURE) return liquids[fluid].antoine_range;
    return liquids[fluid].critical_temperature > 0 ? ppds_range : unknown;
}

static double diffusivity(const struct liquid *liquid, double temperature,
                          double pressure)
{
    static const double air_mass = 28.965e-3, air_volume = 19.7;
    const double mass = 2e3 / (1 / liquid->molar_mass + 1 / air_mass); // g/mol
    const double size = cbrt(liquid->diffusion_volume) + cbrt(air_volume);
    return 1.43e-7 * pow(temperature, 1.75) /
           (pressure / 1e5 * sqrt(mass) * (size * size));
}

static double density(const struct liquid *liquid, double temperature)
{
    const double *c = liquid->density;
    const double theta = 1 - temperature / liquid->critical_temperature;
    return c[0] + c[1] * pow(theta, 0.35) + c[2] * pow(theta, 2.0 / 3) + c[3] * theta +
           c[4] * pow(theta, 4.0 / 3);
}

static double dynamic_viscosity(const struct liquid *liquid, double temperature)
{
    const double *c = liquid->viscosity;
    const double x = (c[2] - temperature) / (temperature - c[3]), root = cbrt(x);
    return c[4] * exp(c[0] * root + c[1] * (x * root));
}

static double surface_tension(const struct liquid *liquid, double temperature)
{
    const double *c = liquid->surface_tension;
    const double t = temperature / liquid->critical_temperature;
    return c[0] * pow(1 - t, c[1] + t * (c[2] + t * (c[3] + t * c[4])));
}

static double value_of_water(enum fluid_property property, double temperature)
{
    switch (property) {
    case FLUID_SATURATION_PRESSURE:
        return water_saturation_pressure(temperature);
    case FLUID_DENSITY:
        return water_density(temperature);
    case FLUID_VISCOSITY:
        return water_dynamic_viscosity(temperature) / water_density(temperature);
    case FLUID_SURFACE_TENSION:
        return water_surface_tension(temperature);
    default:
        return NAN;
    }
}

static double value_of(const struct liquid *liquid, enum fluid_property property,
                       double temperature)
{
    const double *antoine = liquid->antoine;
    switch (property) {
    case FLUID_SATURATION_PRESSURE:
        return pow(10, antoine[0] - antoine[1] / (temperature + antoine[2]));
    case FLUID_DENSITY:
        return density(liquid, temperature);
    case FLUID_VISCOSITY:
        return dynamic_viscosity(liquid, temperature) / density(liquid, temperature);
    case FLUID_SURFACE_TENSION:
        return surface_tension(liquid, temperature);
    default:
        return NAN;
    }
}

double fluid_value(enum fluid fluid, enum fluid_property property, double temperature,
                   double pressure)
{
    const struct liquid *liquid = &liquids[fluid];
    const struct fluid_range range = fluid_range(fluid, property);
    if (!(temperature >= range.from && temperature <= range.to)) return NAN;
    if (property == FLUID_MOLAR_MASS) return liquid->molar_mass;
    if (property == FLUID_DIFFUSIVITY)
        return diffusivity(liquid, temperature, pressure);
    return fluid == FLUID_WATER ? value_of_water(property, temperature)
                                : value_of(liquid, property, temperature);
}

double air_viscosity(double temperature, double pressure)
{
    static const double gas_constant = 287.05; // J/(kg K), of dry air
    if (!(temperature >= 200 && temperature <= 600)) return NAN;
    const double dynamic =
        1.458e-6 * temperature * sqrt(temperature) / (temperature + 110.4); // Pa s
    return dynamic * gas_constant * temperature / pressure;
}
