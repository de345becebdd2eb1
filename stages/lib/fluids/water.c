// SPDX-License-Identifier: GPL-3.0-or-later
// With theta = 1 - T/Tc:
//   saturation pressure  ln(p/pc) = (Tc/T) sum a theta^b            [SR1-86, eq. 1]
//   surface tension      sigma = B theta^mu (1 + b theta)           [R1-76, eq. 1]
//   density, 0.1 MPa     1/rho = (R Tr/p0) (a5 + sum a alpha^n + sum b beta^m),
//                        alpha = Tr/(593 K - T), beta = Tr/(T - 232 K)
//                                                                   [SR6-08, eq. 2]
//   viscosity, 0.1 MPa   mu = 1e-6 Pa s sum a (T/300 K)^b           [SR6-08, eq. 7]
#include "fluids/water.h"

#include <math.h>
#include <stddef.h>

static const double CRITICAL_TEMPERATURE = 647.096, CRITICAL_PRESSURE = 22.064e6;

struct term {
    double factor, power;
};

static double sum_of_powers(const struct term *term, size_t count, double base)
{
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += term[k].factor * pow(base, term[k].power);
    return sum;
}

double water_saturation_pressure(double temperature)
{
    static const struct term term[] = {{-7.85951783, 1}, {1.84408259, 1.5},
                                       {-11.7866497, 3}, {22.6807411, 3.5},
                                       {-15.9618719, 4}, {1.80122502, 7.5}};
    const double theta = 1 - temperature / CRITICAL_TEMPERATURE;
    const double sum = sum_of_powers(term, sizeof term / sizeof *term, theta);
    return CRITICAL_PRESSURE * exp(CRITICAL_TEMPERATURE / temperature * sum);
}

double water_surface_tension(double temperature)
{
    const double theta = 1 - temperature / CRITICAL_TEMPERATURE;
    return 235.8e-3 * pow(theta, 1.256) * (1 - 0.625 * theta);
}

double water_density(double temperature)
{
    static const struct term in_alpha[] = {{6.74458446e3, 4},
                                           {-2.22521604e5, 5},
                                           {1.00231247e8, 7},
                                           {-1.63552118e9, 8},
                                           {8.32299658e9, 9}};
    static const struct term in_beta[] = {{5.78545292e-3, 1}, {-1.53195665e-2, 2},
                                          {3.11337859e-2, 3}, {-4.23546241e-2, 4},
                                          {3.38713507e-2, 5}, {-1.19946761e-2, 6}};
    static const double gas_constant = 461.51805;  // J/(kg K)
    static const double unit = 10, pressure = 1e5; // K, Pa
    const double alpha = unit / (593 - temperature), beta = unit / (temperature - 232);
    const double sum =
        1.93763157e-2 +
        sum_of_powers(in_alpha, sizeof in_alpha / sizeof *in_alpha, alpha) +
        sum_of_powers(in_beta, sizeof in_beta / sizeof *in_beta, beta);
    return pressure / (gas_constant * unit * sum);
}

double water_dynamic_viscosity(double temperature)
{
    static const struct term term[] = {
        {280.68, -1.9}, {511.45, -7.7}, {61.131, -19.6}, {0.45903, -40}};
    return 1e-6 * sum_of_powers(term, sizeof term / sizeof *term, temperature / 300);
}
