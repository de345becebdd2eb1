// SPDX-License-Identifier: GPL-3.0-or-later
// What nothing external can change: momentum and angular momentum to rounding, whatever
// slips or breaks; energy, without dashpots and friction, to second order in the step.
#include "../dem_scene.h"

static const double speed = 1e-2; // m/s

TEST(momentum)
{
    struct packing packing = cubic_lattice(4, 4, 4, false);
    keeps_momentum(stiff_setup(&packing), speed);
    packing_free(&packing);
}

// The largest change of energy, as a fraction of it, over one fixed time.
static double energy_error(double safety)
{
    struct packing packing = cubic_lattice(3, 3, 3, false);
    struct dem_setup setup = stiff_setup(&packing);
    setup.material.normal_stiffness = 0; // a contact that opens is no smooth spring
    setup.material.shear_stiffness = 0;
    setup.material.damping_ratio = 0;
    setup.material.friction = 0;
    setup.time_step_safety = safety;
    struct dem *dem = shaken(&setup, speed, 7);
    run(dem, 1);
    const struct dem_energy first = dem_energy(dem);
    double worst = 0;
    for (int k = 0; k < 20; k++) {
        run(dem, (int64_t)(0.5 / safety + 0.5));
        const struct dem_energy now = dem_energy(dem);
        worst = fmax(worst,
                     fabs(now.kinetic + now.elastic - first.kinetic - first.elastic));
        assert_true(now.elastic > 0.05 * first.kinetic); // it does go back and forth
    }
    dem_free(dem);
    packing_free(&packing);
    return worst / (first.kinetic + first.elastic);
}

TEST(energy_is_second_order)
{
    const double coarse = energy_error(0.02), fine = energy_error(0.01);
    const double finest = energy_error(0.005);
    assert_true(coarse < 2e-2);
    const double order = log2(coarse / fine), finer_order = log2(fine / finest);
    if (!(fabs(order - 2) < 0.25 && fabs(finer_order - 2) < 0.1))
        fail_msg("errors %g, %g, %g: orders %g, %g", coarse, fine, finest, order,
                 finer_order);
}

// With dashpots energy only falls.
TEST(dashpots_take_energy)
{
    struct packing packing = cubic_lattice(3, 3, 3, false);
    struct dem_setup setup = stiff_setup(&packing);
    struct dem *dem = shaken(&setup, speed, 7);
    run(dem, 1);
    struct dem_energy before = dem_energy(dem);
    for (int k = 0; k < 50; k++) {
        run(dem, 10);
        const struct dem_energy now = dem_energy(dem);
        assert_true(now.kinetic + now.elastic < before.kinetic + before.elastic);
        before = now;
    }
    dem_free(dem);
    packing_free(&packing);
}

// With the inertia of the mean grain all fall by their own weight.
TEST(density_scaling)
{
    struct packing packing = new_packing(3, 0);
    double mean = 0;
    for (int i = 0; i < 3; i++) {
        packing.radius[i] = (i + 1) * RADIUS;
        packing.position[i].x = 10 * i * RADIUS;
        mean += pow(i + 1, 3) / 3;
    }
    packing.upper = (struct vector){40 * RADIUS, 9 * RADIUS, 9 * RADIUS};
    struct dem_setup setup = stiff_setup(&packing);
    setup.density_scaling = true;
    setup.gravity = (struct vector){0, 0, -9.81};
    struct dem *dem = create(&setup);
    run(dem, 100);
    struct vector velocity[3];
    dem_velocities(dem, velocity);
    for (int i = 0; i < 3; i++)
        assert_close(velocity[i].z,
                     -9.81 * pow(i + 1, 3) / mean * 100 * dem_time_step(dem), 1e-12);
    dem_free(dem);
    packing_free(&packing);
}
