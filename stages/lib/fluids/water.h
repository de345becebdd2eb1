// SPDX-License-Identifier: GPL-3.0-or-later
// Water, from 273.15 K to 383.15 K: the equations of IAPWS (fluids.h names the
// releases), each of a temperature in K. Density and viscosity are those at 0.1 MPa.
// The range is not checked here: fluid_value does. Other liquids are in fluids.h, which
// calls this for water.
#pragma once

double water_saturation_pressure(double temperature); // Pa
double water_surface_tension(double temperature);     // N/m
double water_density(double temperature);             // kg/m3
double water_dynamic_viscosity(double temperature);   // Pa s
