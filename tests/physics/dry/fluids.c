// SPDX-License-Identifier: GPL-3.0-or-later
// What liquids are like, beside published values that the correlations do not come
// from.
#include "../../test.h"

#include "fluids/fluids.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static double of(enum fluid fluid, enum fluid_property property, double temperature)
{
    return fluid_value(fluid, property, temperature, 1e5);
}

// IAPWS-95 (Wagner and Pruss, J. Phys. Chem. Ref. Data 31 (2002) 387, table 13.1), to
// the digits printed there; at 300 K IAPWS-IF97, R7-97(2012), table 35.
TEST(water_has_the_saturation_pressure_of_iapws_95)
{
    static const double value[][2] = {
        {273.16, 611.657}, {280, 991.8}, {300, 3536.58941}, {310, 6231},
        {320, 10546},      {330, 17213}, {340, 27188},      {350, 41682},
        {360, 62194},      {370, 90535}, {373.1243, 101325}};
    for (size_t k = 0; k < COUNT(value); k++)
        assert_close(of(FLUID_WATER, FLUID_SATURATION_PRESSURE, value[k][0]),
                     value[k][1], 1e-4);
}

// IAPWS R1-76(2014), table 1: mN/m at degrees Celsius, to the digits printed.
TEST(water_has_the_surface_tension_of_iapws)
{
    static const double value[][2] = {
        {0.01, 75.65}, {5, 74.94},  {10, 74.22}, {15, 73.49}, {20, 72.74},
        {25, 71.97},   {30, 71.19}, {40, 69.60}, {50, 67.94}, {60, 66.24},
        {70, 64.48},   {80, 62.67}, {90, 60.82}, {100, 58.91}};
    for (size_t k = 0; k < COUNT(value); k++)
        assert_within(of(FLUID_WATER, FLUID_SURFACE_TENSION, 273.15 + value[k][0]),
                      value[k][1] * 1e-3, 0.0051e-3);
}

// CRC Handbook of Chemistry and Physics, 86th ed., 6-2 (IAPWS-95 and the viscosity of
// IAPWS): degrees Celsius, kg/m3 and uPa s.
TEST(water_is_as_dense_and_viscous_as_the_tables_say)
{
    static const double value[][3] = {
        {0.01, 999.8, 1791}, {10, 999.7, 1306},     {20, 998.2, 1002},
        {30, 995.6, 797.4},  {40, 992.2, 652.7},    {50, 988.0, 546.5},
        {60, 983.2, 466.0},  {70, 977.8, 403.6},    {80, 971.8, 354.0},
        {90, 965.3, 314.2},  {99.606, 958.6, 282.7}};
    for (size_t k = 0; k < COUNT(value); k++) {
        const double temperature = 273.15 + value[k][0];
        const double density = of(FLUID_WATER, FLUID_DENSITY, temperature);
        assert_within(density, value[k][1], 0.06);
        assert_close(density * of(FLUID_WATER, FLUID_VISCOSITY, temperature),
                     value[k][2] * 1e-6, 1.5e-3);
    }
    // ISO/TR 3666 (1998): 1.0034 mm2/s.
    assert_close(of(FLUID_WATER, FLUID_VISCOSITY, 293.15), 1.0034e-6, 5e-4);
}

// Boiling points at 101325 Pa (CRC Handbook).
TEST(liquids_boil_where_they_should)
{
    static const struct {
        enum fluid fluid;
        double temperature;
    } value[] = {{FLUID_METHANOL, 337.65},
                 {FLUID_ETHANOL, 351.39},
                 {FLUID_ISOPROPANOL, 355.36},
                 {FLUID_ACETONE, 329.23},
                 {FLUID_ETHYL_ACETATE, 350.25},
                 {FLUID_HEXANE, 341.87},
                 {FLUID_HEPTANE, 371.53},
                 {FLUID_TOLUENE, 383.75},
                 {FLUID_NMP, 477}};
    for (size_t k = 0; k < COUNT(value); k++)
        assert_close(
            of(value[k].fluid, FLUID_SATURATION_PRESSURE, value[k].temperature), 101325,
            5e-3);
}

// Reference equations of state (Schroeder et al. 2014 for ethanol, de Reuck and Craven
// 1993 for methanol, Lemmon and Span 2006 for acetone and toluene), at saturation.
TEST(liquids_are_as_their_equations_of_state_have_them)
{
    static const struct {
        enum fluid fluid;
        double temperature, pressure, density;
    } value[] = {
        {FLUID_METHANOL, 283.15, 7400.0, 800.7}, {FLUID_METHANOL, 298.15, 16899, 786.6},
        {FLUID_METHANOL, 333.15, 84476, 752.9},  {FLUID_ETHANOL, 283.15, 3147.7, 797.6},
        {FLUID_ETHANOL, 298.15, 7884.0, 785.2},  {FLUID_ETHANOL, 333.15, 46738, 754.8},
        {FLUID_ACETONE, 273.15, 9298.7, 812.1},  {FLUID_ACETONE, 298.15, 30728, 784.5},
        {FLUID_ACETONE, 313.15, 56585, 767.4},   {FLUID_TOLUENE, 293.15, 2918.8, 867.2},
        {FLUID_TOLUENE, 333.15, 18539, 829.7},   {FLUID_TOLUENE, 373.15, 74250, 789.9}};
    for (size_t k = 0; k < COUNT(value); k++) {
        const double temperature = value[k].temperature;
        assert_close(of(value[k].fluid, FLUID_SATURATION_PRESSURE, temperature),
                     value[k].pressure, 7e-3);
        assert_close(of(value[k].fluid, FLUID_DENSITY, temperature), value[k].density,
                     2e-3);
    }
}

// VDI Heat Atlas, tables of saturated liquids (other data than its PPDS equations), and
// for the densities at 293.15 or 298.15 K the CRC Handbook: K, kg/m3, mPa s. The
// table's isopropanol at its boiling point is 1.1 % denser than that of DIPPR (724
// kg/m3) as well.
TEST(liquids_are_as_dense_and_viscous_as_the_tables_say)
{
    static const struct {
        enum fluid fluid;
        double temperature, density, viscosity; // NAN: not in the table
    } value[] = {{FLUID_METHANOL, 280, 803.22, 0.713},
                 {FLUID_METHANOL, 337.63, 748.35, 0.329},
                 {FLUID_ETHANOL, 300, 783.82, 1.043},
                 {FLUID_ETHANOL, 340, 747.74, 0.534},
                 {FLUID_ISOPROPANOL, 298.15, 780.9, NAN},
                 {FLUID_ISOPROPANOL, 355.65, 732.3, 0.502},
                 {FLUID_ACETONE, 329.23, 748.95, 0.235},
                 {FLUID_ETHYL_ACETATE, 293.15, 900.3, NAN},
                 {FLUID_ETHYL_ACETATE, 350.25, 830, 0.255},
                 {FLUID_HEXANE, 300, 653.0, 0.2948},
                 {FLUID_HEXANE, 341.86, 613.0, 0.2037},
                 {FLUID_HEPTANE, 298.15, 679.5, NAN},
                 {FLUID_HEPTANE, 371.53, 614.2, 0.201},
                 {FLUID_TOLUENE, 320, 841.66, 0.4344},
                 {FLUID_TOLUENE, 350, 812.87, 0.3274}};
    for (size_t k = 0; k < COUNT(value); k++) {
        const enum fluid fluid = value[k].fluid;
        const double density = of(fluid, FLUID_DENSITY, value[k].temperature);
        const double kinematic = of(fluid, FLUID_VISCOSITY, value[k].temperature);
        assert_close(density, value[k].density,
                     fluid == FLUID_ISOPROPANOL ? 0.012 : 3e-3);
        if (!isnan(value[k].viscosity))
            assert_close(density * kinematic, value[k].viscosity * 1e-3, 0.07);
    }
}

// Jasper, J. Phys. Chem. Ref. Data 1 (1972) 841: sigma = a - b t, mN/m, degrees
// Celsius.
TEST(surface_tensions_are_near_those_of_jasper)
{
    static const struct {
        enum fluid fluid;
        double a, b, most; // off, as a share
    } value[] = {{FLUID_METHANOL, 24.00, 0.0773, 0.01},
                 {FLUID_ETHANOL, 24.05, 0.0832, 0.01},
                 {FLUID_ISOPROPANOL, 22.90, 0.0789, 0.01},
                 {FLUID_ACETONE, 26.26, 0.1120, 0.035},
                 {FLUID_ETHYL_ACETATE, 26.29, 0.1161, 0.02},
                 {FLUID_HEXANE, 20.44, 0.1022, 0.01},
                 {FLUID_HEPTANE, 22.10, 0.0980, 0.015},
                 {FLUID_TOLUENE, 30.90, 0.1189, 0.01}};
    for (size_t k = 0; k < COUNT(value); k++)
        for (int celsius = 20; celsius <= 50; celsius += 10)
            assert_close(of(value[k].fluid, FLUID_SURFACE_TENSION, 273.15 + celsius),
                         (value[k].a - value[k].b * celsius) * 1e-3, value[k].most);
}

// Measured in air: Marrero and Mason (1972) as in the CRC Handbook for water at
// 293.15 and 373.15 K; Perry's Chemical Engineers' Handbook at 273.15 K, both at
// 101325 Pa; Welty, Wicks and Wilson (1984), as D p in Pa m2/s.
TEST(vapours_diffuse_as_measured)
{
    static const struct {
        enum fluid fluid;
        double temperature, pressure, diffusivity, most;
    } value[] = {{FLUID_WATER, 293.15, 101325, 0.242e-4, 0.01},
                 {FLUID_WATER, 298, 1, 2.634, 0.05},
                 {FLUID_WATER, 373.15, 101325, 0.399e-4, 0.08},
                 {FLUID_METHANOL, 298, 1, 1.641, 0.02},
                 {FLUID_ETHANOL, 273.15, 101325, 0.102e-4, 0.04},
                 {FLUID_ETHANOL, 298, 1, 1.337, 0.08},
                 {FLUID_ETHYL_ACETATE, 273.15, 101325, 0.0715e-4, 0.05},
                 {FLUID_TOLUENE, 298, 1, 0.855, 0.05},
                 {FLUID_ACETONE, 273.15, 101325, 0.109e-4, 0.18}};
    for (size_t k = 0; k < COUNT(value); k++)
        assert_close(fluid_value(value[k].fluid, FLUID_DIFFUSIVITY,
                                 value[k].temperature, value[k].pressure),
                     value[k].diffusivity, value[k].most);
}

TEST(diffusivity_goes_with_temperature_and_pressure)
{
    for (int fluid = 0; fluid < FLUID_OTHER; fluid++) {
        const double at_room = of(fluid, FLUID_DIFFUSIVITY, 293.15);
        assert_close(of(fluid, FLUID_DIFFUSIVITY, 353.15) / at_room,
                     pow(353.15 / 293.15, 1.75), 1e-14);
        assert_close(fluid_value(fluid, FLUID_DIFFUSIVITY, 293.15, 5e3) / at_room, 20,
                     1e-14);
    }
}

// Kadoya et al., J. Phys. Chem. Ref. Data 14 (1985) 947, of dry air at 0.1 MPa: 18.46
// uPa s at 300 K and 21.74 at 370 K, over the density of an ideal gas of 28.965 g/mol.
TEST(air_is_as_viscous_as_measured)
{
    const double gas_constant = 8.314462618 / 28.965e-3;
    assert_close(air_viscosity(300, 1e5), 18.46e-6 * gas_constant * 300 / 1e5, 0.01);
    assert_close(air_viscosity(370, 5e4), 21.74e-6 * gas_constant * 370 / 5e4, 0.01);
}

TEST(nothing_is_told_beyond_its_range)
{
    for (int fluid = 0; fluid < FLUID_COUNT; fluid++)
        for (int property = 0; property < FLUID_PROPERTIES; property++) {
            const struct fluid_range range = fluid_range(fluid, property);
            if (range.from <= range.to) {
                assert_true(of(fluid, property, range.from + 0.01) > 0);
                if (isfinite(range.to))
                    assert_true(isnan(of(fluid, property, range.to + 0.01)));
                if (range.from > 0)
                    assert_true(isnan(of(fluid, property, range.from - 0.01)));
            } else
                assert_true(isnan(of(fluid, property, 300)));
            assert_true(isnan(of(fluid, property, NAN)));
        }
    assert_true(isnan(air_viscosity(150, 1e5)));
}
