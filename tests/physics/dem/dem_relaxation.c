// SPDX-License-Identifier: GPL-3.0-or-later
// What makes grains come to rest in fewer steps: an adapted time step against closed
// forms of two grains and of a flight; inertia and weights against free fall; inertia
// by contacts against the closed form of a row.
#include "../dem_scene.h"

static double mass_of(double radius)
{
    return 3230 * 4.0 / 3 * M_PI * pow(radius, 3);
}

// Two grains that touch along x.
static struct packing two_grains(void)
{
    struct packing packing = new_packing(2, 0);
    packing.position[1].x = 1.999 * RADIUS;
    packing.upper =
        (struct vector){20 * RADIUS, 20 * RADIUS, 20 * RADIUS}; // walls are far
    return packing;
}

// They sway with 2 k/m along or 7 K/m across; local damping makes springs and dashpots
// stronger by its share.
static double closed_form(const struct dem_material *material)
{
    const double mass = mass_of(RADIUS), stronger = 1 + material->local_damping;
    const double k = 0.5 * material->normal_stiffness;
    const double across = material->friction > 0 ? 0.5 * material->shear_stiffness : 0;
    const double springs = stronger * fmax(2 * k, 7 * across) / mass;
    const double dashpots = stronger * fmax(2 * sqrt(k), 7 * sqrt(across)) *
                            material->damping_ratio * sqrt(2 * mass) / mass;
    return 4 / (dashpots + sqrt(dashpots * dashpots + 4 * springs));
}

TEST(step_of_two_grains)
{
    for (int k = 0; k < 8; k++) {
        struct packing packing = two_grains();
        struct dem_setup setup = stiff_setup(&packing);
        setup.material.friction = k & 1 ? 0.5 : 0;
        setup.material.damping_ratio = k & 2 ? 0.7 : 0;
        setup.material.local_damping = k & 4 ? 0.3 : 0;
        setup.time_step_safety = 0.01;
        struct dem *dem = create(&setup);
        dem_adapt_time_step(dem, 0.8, true, 0);
        const double ratio = dem_time_step(dem) / (0.8 * closed_form(&setup.material));
        // the arm is shorter by half the overlap
        assert_true(ratio > 0.996 && ratio < 1.002);
        assert_close(dem_time_step(dem), 0.8 * dem_time_step_limit(dem), 1e-12);
        dem_free(dem);
        packing_free(&packing);
    }
}

// Time goes on from one step to the next.
TEST(clock_across_steps)
{
    struct packing packing = two_grains();
    struct dem_setup setup = stiff_setup(&packing);
    struct dem *dem = create(&setup);
    double expected = 0;
    for (int k = 1; k < 5; k++) {
        dem_adapt_time_step(dem, 0.2 * k, true, 0);
        expected += 100 * dem_time_step(dem);
        run(dem, 100);
        assert_close(dem_time(dem), expected, 1e-12);
    }
    dem_free(dem);
    packing_free(&packing);
}

// In one step a surface moves by 0.04 mean radii at most, at its speed or the one
// given.
TEST(step_of_a_flight)
{
    struct packing packing = new_packing(1, 0);
    packing.position[0] = (struct vector){10 * RADIUS, 10 * RADIUS, 10 * RADIUS};
    packing.upper = (struct vector){20 * RADIUS, 20 * RADIUS, 20 * RADIUS};
    struct dem_setup setup = stiff_setup(&packing);
    struct dem *dem = create(&setup);
    const struct vector velocity = {300, 0, 400}, spin = {0, 500 / RADIUS, 0};
    dem_set_velocity(dem, &velocity, &spin);
    dem_adapt_time_step(dem, 0.9, false, 0);
    assert_close(dem_time_step(dem), 0.04 * RADIUS / 1000, 1e-12);
    dem_adapt_time_step(dem, 0.9, false, 4000);
    assert_close(dem_time_step(dem), 0.04 * RADIUS / 4000, 1e-12);
    dem_adapt_time_step(dem, 0.9, false, 1);
    assert_close(dem_time_step(dem), 0.04 * RADIUS / 1000, 1e-12);
    dem_free(dem);
    packing_free(&packing);
}

enum { N = 4 };

// What each grain gains of speed downwards in one step of free fall, over g dt.
static void fall_once(struct dem *dem, const double expected[N])
{
    const struct vector still[N] = {{0, 0, 0}};
    struct vector velocity[N];
    dem_set_velocity(dem, still, still);
    run(dem, 1);
    dem_velocities(dem, velocity);
    for (int i = 0; i < N; i++)
        assert_close(velocity[i].z / (-9.81 * dem_time_step(dem)), expected[i], 1e-12);
}

TEST(free_fall)
{
    struct packing packing = new_packing(N, 0);
    double mass[N], sum = 0, heavy = 0;
    for (int i = 0; i < N; i++) {
        packing.radius[i] = RADIUS * (1 + i);
        packing.position[i] = (struct vector){(10 * i + 5) * RADIUS, 0, 0};
        mass[i] = mass_of(packing.radius[i]);
        sum += mass[i];
    }
    packing.lower = (struct vector){0, -20 * RADIUS, -20 * RADIUS};
    packing.upper = (struct vector){50 * RADIUS, 20 * RADIUS, 20 * RADIUS};
    struct dem_setup setup = stiff_setup(&packing);
    setup.gravity.z = -9.81;
    struct dem *dem = create(&setup);
    const double share = 0.5, least = share * sum / N;
    double own[N], slow[N], alike[N];
    for (int i = 0; i < N; i++)
        heavy += fmax(mass[i], least);
    for (int i = 0; i < N; i++) {
        own[i] = 1;
        slow[i] = mass[i] / fmax(mass[i], least);
        alike[i] = sum / heavy; // together as heavy as they are
    }
    assert_true(slow[0] < 0.1 && slow[N - 1] >= 1);
    fall_once(dem, own);
    dem_set_least_mass(dem, share, true);
    fall_once(dem, alike);
    dem_set_least_mass(dem, share, false);
    fall_once(dem, slow);
    dem_set_least_mass(dem, 0, false);
    fall_once(dem, own);
    dem_free(dem);
    packing_free(&packing);
}

// Three grains in a row along x, between neighbours that do not slide: the middle one
// sways against both by 2 * 2 k/m, an end by 2 k/m, two alone by 2 k/m.
TEST(steps_of_a_row)
{
    struct packing packing = new_packing(3, 0);
    for (int i = 0; i < 3; i++)
        packing.position[i].x = 1.999 * RADIUS * i;
    packing.upper = (struct vector){20 * RADIUS, 20 * RADIUS, 20 * RADIUS};
    struct dem_setup setup = stiff_setup(&packing);
    setup.material.friction = setup.material.damping_ratio = 0;
    setup.gravity.z = -9.81;
    const double alone = 2 / sqrt(setup.material.normal_stiffness / mass_of(RADIUS));
    const struct {
        double contacts, middle;
        bool falls;
    } cases[] = {{1, 2, true}, {2, 1, true}, {1, 2, false}, {4, 1, true}};
    for (int k = 0; k < 4; k++) {
        double ratio[3];
        struct vector velocity[3];
        const double middle = cases[k].middle;
        struct dem *dem = create(&setup);
        dem_set_least_mass(dem, 1, cases[k].falls);
        dem_even_steps(dem, cases[k].contacts, true);
        dem_adapt_time_step(dem, 0.8, true, 0);
        dem_inertia_ratios(dem, ratio);
        for (int i = 0; i < 3; i++)
            assert_close(ratio[i], i == 1 ? middle : 1, 1e-9);
        assert_close(dem_time_step(dem), 0.8 * alone * sqrt(middle / 2), 1e-9);
        const struct vector still[3] = {{0, 0, 0}};
        dem_set_velocity(dem, still, still);
        run(dem, 1);
        dem_velocities(dem, velocity);
        for (int i = 0; i < 3; i++) { // together as heavy as they are
            const double alike = 3 / (2 + middle), own = 1 / ratio[i];
            assert_close(velocity[i].z / (-9.81 * dem_time_step(dem)),
                         cases[k].falls ? alike : own, 1e-9);
        }
        dem_free(dem);
    }
    packing_free(&packing);
}
