// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of docs/contacts.md: the tests of Chung & Ooi (2011) in steps so fine that
// they do not matter, next to what they should give. Columns marked "read" are points
// of their figures as Kratos' DEM benchmarks hold them (paper_data), good to half a per
// cent of the axis; the materials and velocities are theirs.
#include "../physics/dem/dem_impact_materials.h"
#include "../physics/dem/dem_impact_theory.h"

#include <stdio.h>

static const double degree = M_PI / 180;

static struct outcome finely(struct impact *is)
{
    is->law = DEM_HERTZ;
    is->time_step = hertz_time(is) / 20000;
    return run_impact(is);
}

// Of the surface, over mu times that of the centre along the normal.
static double rebound_of_surface(const struct impact *is, const struct outcome *got)
{
    const double surface = got->velocity[0].x - is->radius[0] * got->spin[0].y;
    return surface / (is->material.friction * got->velocity[0].z);
}

static void print_elastic(const char *name, struct impact is)
{
    const struct outcome got = finely(&is);
    printf("%-12s %.3f N, %.4f um, %.4f us; closed form %.3f, %.4f, %.4f\n", name,
           got.peak_force, 1e6 * got.peak_overlap, 1e6 * got.contact_time,
           hertz_force(&is), 1e6 * hertz_overlap(&is), 1e6 * hertz_time(&is));
}

static void print_tests_1_and_2(void)
{
    struct impact is = {.radius = {0.01, 0.01},
                        .velocity = {{0, 0, -10}, {0, 0, 10}},
                        .material = glass};
    printf("# tests 1 and 2\n");
    print_elastic("glass", is);
    is.material = limestone;
    print_elastic("limestone", is);
    is = (struct impact){.radius = {0.1, 0}, .velocity = {{0, 0, -0.2}}};
    for (int k = 0; k < 4; k++) {
        const char *name[4] = {"Al, rigid", "Al, same", "Mg, rigid", "Mg, same"};
        is.material = k < 2 ? aluminium : magnesium;
        is.elastic_plane = k % 2;
        print_elastic(name[k], is);
    }
}

static void print_test_3(void)
{
    printf("# test 3: e, rebound ratio of Al oxide, of cast iron\n");
    for (int tenths = 2; tenths <= 10; tenths++) {
        struct impact is = {.radius = {2.5e-3, 0}, .velocity = {{0, 0, -3.9}}};
        is.material = oxide;
        is.material.restitution = 0.1 * tenths;
        const double of_oxide = finely(&is).velocity[0].z / 3.9;
        is.material = cast_iron;
        is.material.restitution = 0.1 * tenths;
        printf("%.1f %.6f %.6f\n", 0.1 * tenths, of_oxide,
               finely(&is).velocity[0].z / 3.9);
    }
}

static struct impact oxide_at(double angle)
{
    return (struct impact){
        .material = oxide,
        .radius = {2.5e-3, 0},
        .velocity = {{3.9 * sin(angle * degree), 0, -3.9 * cos(angle * degree)}}};
}

static void print_test_4(void)
{
    // degrees, tangential restitution, -rad/s of Chung & Ooi's own simulation
    const double read[][3] = {{5, 0.948, 19},   {10, 0.687, 213}, {15, 0.624, 378},
                              {20, 0.616, 511}, {25, 0.634, 599}, {30, 0.684, 617},
                              {35, 0.737, 582}, {40, 0.781, 545}, {50, 0.845, 457},
                              {60, 0.893, 357}, {70, 0.932, 246}, {80, 0.966, 126},
                              {85, 0.983, 63}};
    printf(
        "# test 4: degrees; tangential restitution and rad/s of ours, of the law, of "
        "theirs (read), of sliding throughout; surface's rebound in degrees of ours, "
        "of partial slip\n");
    for (int k = 0; k < 13; k++) {
        struct impact is = oxide_at(read[k][0]);
        const struct outcome got = finely(&is), law = integrate_law(&is);
        const double across = is.velocity[0].x, v = closing_speed(&is);
        const double change = 0.092 * 1.98 * v;
        const double partial = partial_slip_rebound(across / v / 0.092, 0.23);
        printf("%2.0f  %.4f %.1f  %.4f %.1f  %.3f %.0f  %.4f %.1f  %.2f %.2f\n",
               read[k][0], got.velocity[0].x / across, got.spin[0].y,
               law.velocity[0].x / across, law.spin[0].y, read[k][1], read[k][2],
               1 - change / across, 2.5 * change / 2.5e-3,
               atan(0.092 * rebound_of_surface(&is, &got)) / degree,
               atan(0.092 * partial) / degree);
    }
}

// Kharaz, Gorham & Salman (2001), measured.
static void print_measured(void)
{
    const double restitution[][2] = {{4.22, 0.746},  {9.84, 0.675},  {20.22, 0.599},
                                     {30.36, 0.690}, {39.54, 0.774}, {49.60, 0.848},
                                     {71.07, 0.937}, {79.23, 0.970}};
    printf("# measured (read): degrees, tangential restitution, ours, partial slip\n");
    for (int k = 0; k < 8; k++) {
        struct impact is = oxide_at(restitution[k][0]);
        const struct outcome got = finely(&is);
        const double tangent = tan(restitution[k][0] * degree);
        const double left =
            0.092 * partial_slip_rebound(tangent / 0.092, 0.23) / tangent;
        printf("%.2f %.3f %.4f %.4f\n", restitution[k][0], restitution[k][1],
               got.velocity[0].x / is.velocity[0].x, 1 - 2.0 / 7 * (1 - left));
    }
    const double spin[][2] = {{5.90, 135},  {10.87, 261}, {21.12, 574}, {31.14, 612},
                              {38.95, 595}, {50.24, 450}, {60.10, 376}, {69.96, 243},
                              {78.56, 142}, {84.32, 71}};
    printf("# measured (read): degrees, rad/s, ours, partial slip\n");
    for (int k = 0; k < 10; k++) {
        struct impact is = oxide_at(spin[k][0]);
        const double tangent = tan(spin[k][0] * degree), v = closing_speed(&is);
        const double left = 0.092 * partial_slip_rebound(tangent / 0.092, 0.23);
        printf("%.2f %.0f %.1f %.1f\n", spin[k][0], spin[k][1], finely(&is).spin[0].y,
               5.0 / 7 * (tangent - left) * v / 2.5e-3);
    }
}

static void print_test_5(void)
{
    // Finite elements of Wu, Thornton & Li (2003).
    const double read[][2] = {
        {0.272, -0.03}, {0.586, -0.03}, {0.876, -0.08}, {1.190, -0.21}, {1.553, -0.37},
        {1.915, -0.63}, {2.314, -0.95}, {2.785, -1.25}, {3.317, -1.52}, {3.970, -1.72},
        {4.755, -1.71}, {5.758, -1.20}, {7.124, 0.13},  {9.118, 2.15}};
    printf(
        "# test 5: psi before; psi after: ours, the law, partial slip, finite elements "
        "(read)\n");
    for (int k = 0; k < 14; k++) {
        struct impact is = {.material = steel,
                            .radius = {1e-5, 0},
                            .velocity = {{1.5 * read[k][0], 0, -5}}};
        const struct outcome got = finely(&is), law = integrate_law(&is);
        printf("%.3f %.4f %.4f %.4f %.2f\n", read[k][0], rebound_of_surface(&is, &got),
               rebound_of_surface(&is, &law), partial_slip_rebound(read[k][0], 0.3),
               read[k][1]);
    }
    double worst = 0, at = 0;
    for (double psi = 0.05; psi < 8; psi += 0.05) {
        struct impact is = {
            .material = steel, .radius = {1e-5, 0}, .velocity = {{1.5 * psi, 0, -5}}};
        const struct outcome law = integrate_law(&is);
        const double off =
            rebound_of_surface(&is, &law) - partial_slip_rebound(psi, 0.3);
        if (fabs(off) > fabs(worst)) worst = off, at = psi;
    }
    printf("# the law is off partial slip by %.3f at most, at %.2f\n", worst, at);
}

static void print_test_6(void)
{
    // tan of the angle from 3.5 mu (1 + e)/x, beta of Chung & Ooi's own simulation, Al
    const double read[][2] = {{24.009, -0.342}, {7.819, -0.208}, {4.515, -0.140},
                              {2.996, -0.050},  {2.093, 0.058},  {1.454, 0.119},
                              {0.969, -0.028},  {0.771, -0.243}, {0.551, -0.445},
                              {0.352, -0.633},  {0.176, -0.820}};
    printf("# test 6: tan; beta: ours, the law, theirs (read), sliding throughout\n");
    for (int k = 0; k < 11; k++) {
        const double tangent = 2.1 / read[k][0], across = 0.2 * tangent;
        struct impact is = {.material = alloy,
                            .radius = {0.1, 0},
                            .velocity = {{0, 0, -0.2}},
                            .spin = {{0, -across / 0.1, 0}}};
        const struct outcome got = finely(&is), law = integrate_law(&is);
        const double scale = -is.material.friction / across;
        printf("%.4f %.4f %.4f %.3f %.4f\n", tangent,
               scale * rebound_of_surface(&is, &got) * got.velocity[0].z,
               scale * rebound_of_surface(&is, &law) * law.velocity[0].z, read[k][1],
               2.1 / tangent - 1);
    }
}

static void print_tests_7_and_8(void)
{
    printf("# test 7: spin before, after; speed across after\n");
    for (double angle = 5; angle < 90; angle += 40) {
        const double spin = 2 * tan(angle * degree);
        struct impact is = {.material = alloy,
                            .radius = {0.1, 0.1},
                            .velocity = {{0, 0, -0.2}, {0, 0, 0.2}},
                            .spin = {{0, spin, 0}, {0, -spin, 0}}};
        const struct outcome got = finely(&is);
        printf("%.10g %.10g %g\n", spin, got.spin[0].y, got.velocity[0].x);
    }
    printf("# test 8: tan; beta: onto a heavy stiff one, one of the same stuff, "
           "sliding\n");
    for (double angle = 65; angle < 90; angle += 5) {
        const double across = 0.2 * tan(angle * degree);
        double beta[2];
        for (int same = 0; same < 2; same++) {
            struct impact is = {.material = alloy,
                                .other = alloy,
                                .radius = {0.1, 0.5},
                                .velocity = {{0, 0, -0.2}},
                                .spin = {{0, -across / 0.1, 0}}};
            if (!same) is.other.density *= 1000, is.other.young_modulus *= 1000;
            const struct outcome got = finely(&is);
            beta[same] = -(got.velocity[0].x - 0.1 * got.spin[0].y - got.velocity[1].x -
                           0.5 * got.spin[1].y) /
                         across;
        }
        printf("%.4f %.4f %.4f %.4f\n", across / 0.2, beta[0], beta[1],
               3.5 * 0.4 * 1.5 * 0.2 / across - 1);
    }
}

int main(void)
{
    print_tests_1_and_2();
    print_test_3();
    print_test_4();
    print_measured();
    print_test_5();
    print_test_6();
    print_tests_7_and_8();
    return 0;
}
