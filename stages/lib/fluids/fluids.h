// SPDX-License-Identifier: GPL-3.0-or-later
// Liquids by name: what they are like at a temperature, each property from one
// published correlation, in its range of validity and not beyond it. docs/fluids.md
// compares them with values of other sources.
//
// Liquids are pure, under about atmospheric pressure; their vapour diffuses in air.
//
// Sources:
//   water: IAPWS. Saturation pressure: SR1-86(1992), Wagner and Pruss, J. Phys. Chem.
//       Ref. Data 22 (1993) 783. Surface tension: R1-76(2014). Density and viscosity at
//       0.1 MPa: SR6-08(2011), Patek et al., J. Phys. Chem. Ref. Data 38 (2009) 21.
//   the others: saturation pressure: Antoine's equation, Poling, Prausnitz, O'Connell,
//       The Properties of Gases and Liquids, 5th ed. (2001), appendix A; of nmp Dykyj
//       et al., Landolt-Boernstein IV/20C (2001). Density, viscosity, surface tension:
//       VDI Heat Atlas, 2nd ed. (2010), D3.1 (PPDS equations).
//   diffusivity: Fuller, Schettler and Giddings as in Poling et al., eq. 11-4.4 and
//       table 11-1, D ~ T^1.75 / p: within 8 % of what was measured here, but for
//       acetone.
//   air: viscosity by Sutherland's equation, US Standard Atmosphere (1976).
//
// A value is NAN rather than wrong: each correlation ends where its source ends. To add
// a liquid, add it to the enum, to FLUID_CHOICES in the same order, and a row to the
// table of fluids.c; docs/fluids.md compares it with other sources.
#pragma once

#include "basics/status.h"

enum fluid {
    FLUID_WATER,
    FLUID_METHANOL,
    FLUID_ETHANOL,
    FLUID_ISOPROPANOL,
    FLUID_ACETONE,
    FLUID_ETHYL_ACETATE,
    FLUID_HEXANE,
    FLUID_HEPTANE,
    FLUID_TOLUENE,
    FLUID_NMP,   // N-methyl-2-pyrrolidone
    FLUID_OTHER, // of which nothing is known
    FLUID_COUNT
};

#define FLUID_CHOICES                                                                  \
    "water|methanol|ethanol|isopropanol|acetone|ethyl-acetate|n-hexane|n-heptane|"     \
    "toluene|nmp|other"

enum fluid_property {
    FLUID_SATURATION_PRESSURE, // of the vapour over the flat liquid, Pa
    FLUID_DIFFUSIVITY,         // of the vapour in air, m2/s
    FLUID_MOLAR_MASS,          // kg/mol
    FLUID_DENSITY,             // of the liquid, kg/m3
    FLUID_VISCOSITY,           // of the liquid, kinematic, m2/s
    FLUID_SURFACE_TENSION,     // against air, N/m
    FLUID_PROPERTIES
};

const char *fluid_name(enum fluid fluid);

// Where a correlation holds, in K, both ends included; none is known where FROM > TO.
struct fluid_range {
    double from, to;
};
struct fluid_range fluid_range(enum fluid fluid, enum fluid_property property);

// PROPERTY of FLUID at TEMPERATURE (K); only diffusivity depends on PRESSURE (of the
// gas, Pa, above 0). NAN where it is not known, or not at this temperature.
double fluid_value(enum fluid fluid, enum fluid_property property, double temperature,
                   double pressure);

// Kinematic viscosity of dry air, m2/s, at a pressure in Pa above 0 (ideal gas); NAN
// but from 200 to 600 K.
double air_viscosity(double temperature, double pressure);
