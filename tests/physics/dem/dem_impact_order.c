// SPDX-License-Identifier: GPL-3.0-or-later
// How errors of a contact fall with the time step. Leapfrog is of second order while a
// contact lasts, and over a whole elastic impact: where it begins and ends the
// stiffness jumps (linear), or its root grows from nothing (Hertz: order 5/2). Dashpots
// see the velocity of half a step before, and push from the first moment; the shear
// force of a Hertz contact grows by the stiffness at the end of a step: with these all
// is of first order.
#include "../dem_scene.h"
#include "dem_impact_theory.h"

static struct impact spring_impact(double damping_ratio)
{
    return (struct impact){.law = DEM_LINEAR,
                           .material = {.density = 2500,
                                        .normal_stiffness = 1e5,
                                        .damping_ratio = damping_ratio},
                           .radius = {1e-3, 1e-3},
                           .velocity = {{0, 0, -0.1}, {0, 0, 0.1}}};
}

static struct impact hertz_impact(double restitution, double across, double friction)
{
    return (struct impact){.law = DEM_HERTZ,
                           .material = {.density = 2500,
                                        .friction = friction,
                                        .restitution = restitution,
                                        .young_modulus = 1e9,
                                        .poisson_ratio = 0.3},
                           .radius = {1e-3, 0},
                           .velocity = {{across, 0, -0.5}}};
}

static double spring_time(double damping_ratio)
{
    const double mass = 0.5 * sphere_mass(2500, 1e-3);
    return M_PI * sqrt(mass / (0.5e5 * (1 - damping_ratio * damping_ratio)));
}

// ---- while it lasts ----------------------------------------------------------------

// The overlap after a quarter of the contact, touching at the start.
static double quarter_overlap(struct impact is, double time, int steps)
{
    is.time_step = time / steps;
    struct dem *dem = start_impact(&is, 0);
    run(dem, steps / 4);
    struct vector moved[2] = {{0}};
    dem_displacements(dem, moved);
    const double overlap = overlap_now(&is, moved, 0);
    dem_free(dem);
    return overlap;
}

static void assert_order(double coarse, double fine, double wanted, double within)
{
    const double order = log2(fabs(coarse / fine));
    if (!(fabs(order - wanted) <= within))
        fail_msg("errors %g, %g: order %g, wanted %g", coarse, fine, order, wanted);
}

static void check_inside(const struct impact *is, double time, double exact,
                         double order)
{
    for (int steps = 40; steps <= 320; steps *= 2)
        assert_order(quarter_overlap(*is, time, steps) - exact,
                     quarter_overlap(*is, time, 2 * steps) - exact, order, 0.1);
}

// U = v/w exp(-g t) sin(w t), with w t = pi/4.
TEST(linear_inside)
{
    for (int damped = 0; damped < 2; damped++) {
        const double ratio = damped ? 0.2 : 0, time = spring_time(ratio);
        const struct impact is = spring_impact(ratio);
        const double decay = ratio / sqrt(1 - ratio * ratio) * M_PI / 4;
        const double exact = 0.2 * time / M_PI * exp(-decay) * sin(M_PI / 4);
        check_inside(&is, time, exact, damped ? 1 : 2);
    }
}

// Undamped: with a dashpot two errors of opposite sign hide the order for long.
TEST(hertz_inside)
{
    const struct impact is = hertz_impact(1, 0, 0);
    const double time = hertz_time(&is);
    check_inside(&is, time, quarter_overlap(is, time, 200000), 2);
}

// ---- from touch to touch -----------------------------------------------------------

// Root mean square over when between two steps they touch and part.
static double rebound_error(struct impact is, double time, int steps,
                            struct vector exact)
{
    enum { TIMES = 12 };
    double sum = 0;
    for (int k = 0; k < TIMES * TIMES; k++) {
        is.onset = (k / TIMES + 0.5) / TIMES;
        is.time_step = time / (steps + (k % TIMES + 0.5) / TIMES - 0.5);
        const struct outcome got = run_impact(&is);
        sum += pow(distance(got.velocity[0], exact), 2);
    }
    return sqrt(sum) / TIMES / fabs(is.velocity[0].z);
}

static void check_rebound(const struct impact *is, double time, struct vector exact,
                          double order, double within)
{
    const double coarse = rebound_error(*is, time, 80, exact);
    const double fine = rebound_error(*is, time, 1280, exact);
    const double mean = 0.25 * log2(coarse / fine);
    if (!(fabs(mean - order) <= within))
        fail_msg("errors %g, %g: order %g, wanted %g", coarse, fine, mean, order);
}

TEST(linear_rebound)
{
    struct impact is = spring_impact(0);
    check_rebound(&is, spring_time(0), (struct vector){0, 0, 0.1}, 2, 0.05);
    is = spring_impact(0.2);
    const double left = exp(-M_PI * 0.2 / sqrt(1 - 0.04));
    check_rebound(&is, spring_time(0.2), (struct vector){0, 0, 0.1 * left}, 1, 0.1);
}

TEST(timed_rebound)
{
    struct impact is = spring_impact(0);
    is.law = DEM_TIMED;
    is.material.contact_time = 1e-4;
    is.material.restitution = 1;
    check_rebound(&is, 1e-4, (struct vector){0, 0, 0.1}, 2, 0.05);
    is.material.restitution = 0.6;
    check_rebound(&is, 1e-4, (struct vector){0, 0, 0.06}, 1, 0.1);
}

TEST(hertz_rebound)
{
    struct impact is = hertz_impact(1, 0, 0);
    check_rebound(&is, hertz_time(&is), (struct vector){0, 0, 0.5}, 2.5, 0.15);
    is = hertz_impact(0.7, 0, 0);
    check_rebound(&is, hertz_time(&is), (struct vector){0, 0, 0.35}, 1, 0.15);
}

TEST(oblique_rebound)
{
    const struct impact is = hertz_impact(1, 0.075, 0.3); // sticks but at its end
    const struct outcome exact = integrate_law(&is);
    check_rebound(&is, hertz_time(&is), exact.velocity[0], 1, 0.1);
}

// ---- energy, without anything that takes it ----------------------------------------

// The mean of the energy over so many CYCLES, weighted so that what swings is left out.
static double mean_energy(struct dem *dem, int cycles)
{
    double sum = 0, weights = 0;
    for (int k = 0; k < cycles; k++) {
        run(dem, 1);
        const struct dem_energy now = dem_energy(dem);
        const double weight = pow(sin(M_PI * (k + 0.5) / cycles), 4);
        sum += weight * (now.kinetic + now.elastic);
        weights += weight;
    }
    return sum / weights;
}

static double drift(struct dem *dem)
{
    const double first = mean_energy(dem, 20000);
    run(dem, 960000);
    const double off = mean_energy(dem, 20000) / first - 1;
    dem_free(dem);
    return off;
}

static void assert_keeps_energy(struct dem *dem, double within)
{
    const double off = drift(dem);
    if (!(fabs(off) < within)) fail_msg("energy drifts by %g", off);
}

enum { ROW = 8 };

// Contact bonds, all along the row: a chain of springs.
TEST(linear_chain_keeps_energy)
{
    struct packing packing = cubic_lattice(ROW, 1, 1, false);
    struct dem_setup setup = stiff_setup(&packing);
    setup.material.damping_ratio = 0;
    setup.bond.kind = DEM_CONTACT_BOND;
    setup.time_step_safety = 0.1;
    struct dem *dem = create(&setup);
    struct vector *velocity = random_vectors(ROW, 1e-3, 3);
    for (int i = 0; i < ROW; i++)
        velocity[i].y = velocity[i].z = 0;
    dem_set_velocity(dem, velocity, NULL);
    assert_keeps_energy(dem, 1e-6);
    free(velocity);
    packing_free(&packing);
}

// Parallel bonds: the row bends, twists and shears.
TEST(bonded_chain_keeps_energy)
{
    struct packing packing = cubic_lattice(ROW, 1, 1, false);
    const uint8_t fixed[ROW] = {1};
    struct dem_setup setup = stiff_setup(&packing);
    setup.material.normal_stiffness = setup.material.shear_stiffness = 0;
    setup.material.damping_ratio = setup.material.friction = 0;
    setup.fixed = fixed;
    setup.time_step_safety = 0.1;
    struct dem *dem = create(&setup);
    struct vector *velocity = random_vectors(ROW, 1e-5, 4);
    struct vector *spin = random_vectors(ROW, 1e-5 / RADIUS, 5);
    dem_set_velocity(dem, velocity, spin);
    assert_keeps_energy(dem, 1e-6);
    free(velocity);
    free(spin);
    packing_free(&packing);
}

// A row between two grains that are held, pressed so that no contact ever opens.
TEST(hertz_row_keeps_energy)
{
    struct packing packing = cubic_lattice(ROW, 1, 1, false);
    packing.n_bond = 0;
    for (int i = 0; i < ROW; i++)
        packing.position[i].x *= 0.995;
    const uint8_t fixed[ROW] = {[0] = 1, [ROW - 1] = 1};
    const struct dem_setup setup = {.packing = &packing,
                                    .law = DEM_HERTZ,
                                    .material = {.density = 2500,
                                                 .restitution = 1,
                                                 .young_modulus = 1e9,
                                                 .poisson_ratio = 0.3},
                                    .fixed = fixed,
                                    .largest_overlap = 0.02,
                                    .time_step_safety = 0.1,
                                    .threads = 1};
    struct dem *dem = create(&setup);
    struct vector *velocity = random_vectors(ROW, 0.1, 6);
    for (int i = 0; i < ROW; i++)
        velocity[i].y = velocity[i].z = 0;
    dem_set_velocity(dem, velocity, NULL);
    assert_keeps_energy(dem, 1e-6);
    free(velocity);
    packing_free(&packing);
}

// A grain between two walls hits them over and over, at the default time step:
// thousands of impacts do not add up, and leave less than one may (docs/contacts.md).
static void assert_bounces(enum dem_law law, double within)
{
    struct vector position = {0, 0, 0};
    double radius = 1e-3;
    const struct packing packing = {
        .n_particle = 1, .position = &position, .radius = &radius};
    const struct dem_wall walls[2] = {{.point = {0, 0, -1.05e-3}, .normal = {0, 0, 1}},
                                      {.point = {0, 0, 1.05e-3}, .normal = {0, 0, -1}}};
    const struct dem_setup setup = {.packing = &packing,
                                    .law = law,
                                    .material = {.density = 2500,
                                                 .normal_stiffness = 1e5,
                                                 .restitution = 1,
                                                 .young_modulus = 1e9,
                                                 .poisson_ratio = 0.3},
                                    .n_wall = 2,
                                    .wall = walls,
                                    .time_step_safety = 0.1,
                                    .threads = 1};
    struct dem *dem = create(&setup);
    dem_set_velocity(dem, &(struct vector){0, 0, 0.5}, NULL);
    assert_keeps_energy(dem, within);
}

TEST(bouncing)
{
    assert_bounces(DEM_LINEAR, 2e-3);
    assert_bounces(DEM_HERTZ, 6e-4);
}
