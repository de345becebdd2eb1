// SPDX-License-Identifier: GPL-3.0-or-later
// What a time step costs and what it gives, for single impacts: errors of the rebound,
// the largest overlap and the contact time against steps a contact, root mean square
// over when between two steps the grains touch.
//
//     impact_study error          a table for tests/bench/impact
//     impact_study default        steps a contact at the default time step
//     impact_study oblique        oblique impacts against theories, for
//     docs/contacts.md impact_study normal         the same for normal ones
#include "../physics/dem/dem_impact_theory.h"

#include <stdio.h>
#include <string.h>

enum { ONSETS = 12 };

struct study {
    const char *name;
    struct impact impact;
    double restitution, time; // s; exact
    struct outcome fine;      // in very small steps
};

static struct study linear(void)
{
    const double mass = 0.5 * sphere_mass(2500, 1e-3);
    return (struct study){"linear",
                          {.law = DEM_LINEAR,
                           .material = {.density = 2500, .normal_stiffness = 1e5},
                           .radius = {1e-3, 1e-3},
                           .velocity = {{0, 0, -0.1}, {0, 0, 0.1}}},
                          1,
                          M_PI * sqrt(mass / 0.5e5),
                          {.peak_force = 0}};
}

static struct study timed(double restitution)
{
    return (struct study){"timed",
                          {.law = DEM_TIMED,
                           .material = {.density = 2500,
                                        .contact_time = 1e-5,
                                        .restitution = restitution},
                           .radius = {1e-3, 1e-3},
                           .velocity = {{0, 0, -0.1}, {0, 0, 0.1}}},
                          restitution,
                          1e-5,
                          {.peak_force = 0}};
}

static struct study hertz(double restitution, double across)
{
    struct study s = {across > 0 ? "oblique" : "hertz",
                      {.law = DEM_HERTZ,
                       .material = {.density = 2500,
                                    .friction = across > 0 ? 0.3 : 0,
                                    .restitution = restitution,
                                    .young_modulus = 1e9,
                                    .poisson_ratio = 0.3},
                       .radius = {1e-3, 1e-3},
                       .velocity = {{across, 0, -0.5}, {-across, 0, 0.5}}},
                      restitution,
                      0,
                      {.peak_force = 0}};
    s.time = hertz_time(&s.impact);
    return s;
}

static struct study study_of(int number)
{
    switch (number) {
    case 0:
        return linear();
    case 1:
        return timed(0.5);
    case 2:
        return hertz(1, 0);
    case 3:
        return hertz(0.5, 0);
    default:
        return hertz(0.9, 0.3);
    }
}
enum { STUDIES = 5 };

static struct outcome in_steps(const struct study *s, double steps, double onset)
{
    struct impact is = s->impact;
    is.time_step = s->time / steps;
    is.onset = onset;
    return run_impact(&is);
}

// Rebound over what came in, peak overlap, contact time, and for oblique impacts what
// the surface does.
static void print_errors(const struct study *s, double steps)
{
    double square[3] = {0, 0, 0};
    const double speed = fabs(s->impact.velocity[0].z);
    for (int k = 0; k < ONSETS * ONSETS; k++) {
        const double onset = (k / ONSETS + 0.5) / ONSETS;
        const double part = (k % ONSETS + 0.5) / ONSETS - 0.5;
        const struct outcome got = in_steps(s, steps + part, onset);
        const double error[3] = {distance(got.velocity[0], s->fine.velocity[0]) / speed,
                                 got.peak_overlap / s->fine.peak_overlap - 1,
                                 got.contact_time / s->fine.contact_time - 1};
        for (int i = 0; i < 3; i++)
            square[i] += error[i] * error[i] / (ONSETS * ONSETS);
    }
    printf("%g %.3g %.3g %.3g\n", steps, sqrt(square[0]), sqrt(square[1]),
           sqrt(square[2]));
}

static void print_study(void)
{
    for (int number = 0; number < STUDIES; number++) {
        struct study s = study_of(number);
        s.fine = in_steps(&s, 50000, 0.5);
        printf("# %s e=%g: steps, errors of rebound, peak overlap, contact time\n",
               s.name, s.restitution);
        for (double steps = 5; steps < 1400; steps *= sqrt(2))
            print_errors(&s, round(steps));
        printf("\n\n");
    }
}

// By the default safety factor.
static void print_default(void)
{
    for (int number = 0; number < STUDIES; number++) {
        const struct study s = study_of(number);
        struct vector position[2] = {{0, 0, 0}, {0, 0, 2 * s.impact.radius[0]}};
        double radius[2] = {s.impact.radius[0], s.impact.radius[0]};
        const struct packing packing = {
            .n_particle = 2, .position = position, .radius = radius};
        const struct dem_setup setup = {.packing = &packing,
                                        .law = s.impact.law,
                                        .material = s.impact.material,
                                        .time_step_safety = 0.1,
                                        .threads = 1};
        struct dem *dem;
        struct reason reason;
        if (dem_create(&dem, &setup, &reason) != STATUS_OK)
            die(STATUS_INTERNAL, "%s", reason.text);
        printf("%s e=%g: %.2f\n", s.name, s.restitution, s.time / dem_time_step(dem));
        dem_free(dem);
    }
}

int main(int argc, char **argv)
{
    if (argc == 2 && !strcmp(argv[1], "error"))
        print_study();
    else if (argc == 2 && !strcmp(argv[1], "default"))
        print_default();
    else
        die(STATUS_USAGE, "error or default");
    return 0;
}
