// SPDX-License-Identifier: GPL-3.0-or-later
// Rolling resistance against closed forms: the sphere that rolls to rest on a plane
// (Ai, Chen, Rotter & Ooi 2011), one on a slope, and two that turn against each other.
#include "basics/cpu_features.h"
#include "wall_scene.h"

static const double rolling = 0.1; // friction

static void resist(struct scene *scene, double damping)
{
    scene->setup.material.normal_stiffness = 1e3;
    scene->setup.material.shear_stiffness = 1e3;
    scene->setup.material.friction = 0.8;
    scene->setup.material.damping_ratio = 0.3;
    scene->setup.material.rolling_friction = rolling;
    scene->setup.material.rolling_damping = damping;
}

// A grain that rolls on a plane, or on a fixed grain of so many radii.
static struct dem *rolls_off(struct scene *scene, struct dem_wall *floor, double large,
                             double damping)
{
    const double rest = weight() / (large > 0 ? 25 : 50);
    const struct vector position[2] = {{0, 0, GRAIN - rest}, {0, 0, -large * GRAIN}};
    static const uint8_t fixed[2] = {0, 1};
    *floor = (struct dem_wall){.normal = {0, 0, 1}};
    set_scene(scene, large > 0 ? 2 : 1, position, large > 0 ? 0 : 1, floor);
    if (large > 0) scene->packing.radius[1] = large * GRAIN;
    resist(scene, damping);
    scene->setup.material.normal_stiffness = 50; // soft: the spring's part shows
    scene->setup.material.shear_stiffness = 50;
    scene->setup.fixed = fixed;
    scene->setup.gravity.z = -gravity;
    scene->setup.time_step = 2e-6;
    return create(&scene->setup);
}

// With F = m g, M = mu_r R F and 7/10 m v^2 of energy at first: the spring takes M^2 /
// (2 k_r) before it yields at the angle M / k_r = F / (k_n mu_r R) / 2.25. So it rolls
//     x = 7/10 v^2 / (mu_r g) + yield/2,  yield = F / (2.25 k_n mu_r),
// then back by YIELD, about where it comes to rest if a dashpot brakes it. That takes
// c_r yield / R of the angular momentum I_r v / R before the spring yields, with
// c_r = 2 eta sqrt(I_r k_r) and I_r = 7/5 m R^2.
static void rolls_to_rest(double large, double damping)
{
    const double speed = 0.02, k = large > 0 ? 25 : 50;
    struct scene scene;
    struct dem_wall floor;
    struct dem *dem = rolls_off(&scene, &floor, large, damping);
    const double arm = GRAIN - 0.5 * weight() / k;
    dem_set_velocity(dem, (struct vector[2]){{speed, 0, 0}, {0, 0, 0}},
                     (struct vector[2]){{0, speed / arm, 0}, {0, 0, 0}});
    const double yield = weight() / (2.25 * k * rolling);
    const double braked = sqrt(2.25 * k / (1.4 * mass())) * rolling;
    const double left = speed - 2 * damping * braked * yield;
    const double way = 0.7 * left * left / (rolling * gravity) + 0.5 * yield;
    const double brakes = 5.0 / 7 * rolling * gravity;
    double furthest = 0;
    for (int step = 0; step < 600; step++) {
        run(dem, 50);
        const double time = dem_time_step(dem) * (double)dem_cycle(dem),
                     v = left - brakes * (time - 0.5 * yield / speed);
        const double x = of_grain(dem, 0, dem_displacements).x;
        if (v > 0.1 * speed && x > 3 * yield) // rolls on, and slows down evenly
            assert_within(of_grain(dem, 0, dem_velocities).x, v, 0.005 * speed);
        furthest = fmax(furthest, x);
    }
    const double within = 0.15 * yield + 1e-3 * way;
    assert_within(furthest, way, within);
    if (damping > 0) {
        run(dem, 100000);
        assert_within(of_grain(dem, 0, dem_displacements).x, way - yield, within);
        assert_true(norm(of_grain(dem, 0, dem_velocities)) < 1e-5 * speed);
    }
    const struct dem_energy now = dem_energy(dem);
    assert_true(now.slip > 0.5 * 0.7 * mass() * speed * speed);
    dem_free(dem);
    packing_free(&scene.packing);
}

TEST(rolls_to_rest)
{
    rolls_to_rest(0, 0);
    rolls_to_rest(0, 0.3);
    rolls_to_rest(1e3, 0); // another kernel: on a fixed grain that is nearly a plane
    rolls_to_rest(1e3, 0.3);
}

// A slope of tan less than mu_r holds the grain; on a steeper one it rolls down with
// 5/7 of what is left of gravity.
TEST(slope)
{
    for (int k = 0; k < 2; k++) {
        const double slope = k ? 0.15 : 0.05, time = 0.2;
        struct scene scene;
        struct dem_wall floor;
        struct dem *dem = rolls_off(&scene, &floor, 0, 0.3);
        const double cosine = 1 / sqrt(1 + slope * slope);
        dem_set_gravity(
            dem, (struct vector){gravity * slope * cosine, 0, -gravity * cosine});
        run(dem, (int64_t)rint(time / dem_time_step(dem)));
        const double speed = of_grain(dem, 0, dem_velocities).x;
        const double down = 5.0 / 7 * gravity * cosine * (slope - rolling) * time;
        if (k)
            assert_close(speed, down, 0.01);
        else
            assert_true(fabs(speed) < 1e-6 * fabs(down));
        dem_free(dem);
        packing_free(&scene.packing);
    }
}

// Two grains pressed together by F that turn against each other: each slows down at M /
// I, M = mu_r R/2 F, and both stop when each has turned by I omega^2 / (2 M), and half
// as far as the spring still turns them. A third grain far away makes each pair keep
// its own coefficients.
static void turn_against(enum dem_law law, bool alone)
{
    const double push = 1e-3, spin = 300;
    const struct vector position[3] = {
        {0, 0, 0}, {0, 0, 2 * GRAIN - 1e-6}, {20 * GRAIN, 0, 0}};
    struct scene scene;
    set_scene(&scene, alone ? 2 : 3, position, 0, NULL);
    if (!alone) scene.packing.radius[2] *= 1.5;
    resist(&scene, 0);
    scene.setup.law = law;
    scene.setup.material.contact_time = 5e-4;
    scene.setup.material.restitution = 0.5;
    scene.setup.time_step = 2e-6;
    struct dem *dem = create(&scene.setup);
    dem_set_force(dem, (struct vector[3]){{0, 0, push}, {0, 0, -push}, {0, 0, 0}});
    run(dem, 20000); // to rest
    dem_set_velocity(dem, NULL,
                     (struct vector[3]){{spin, 0, 0}, {-spin, 0, 0}, {0, 0, 0}});
    const double inertia = 0.4 * mass() * GRAIN * GRAIN;
    const double moment = 0.5 * rolling * GRAIN * push, stop = spin * inertia / moment;
    double turned = 0, most = 0;
    for (int k = 0; k < 100; k++) {
        const int64_t cycles = (int64_t)rint(0.012 * stop / dem_time_step(dem));
        for (int64_t c = 0; c < cycles; c++) {
            run(dem, 1);
            turned += of_grain(dem, 0, dem_spins).x * dem_time_step(dem);
            most = fmax(most, turned);
        }
        const double now = of_grain(dem, 0, dem_spins).x;
        const double v = spin * (1 - 0.012 * (k + 1));
        if (k < 80) assert_within(now, v, 0.005 * spin);
        assert_within(now, -of_grain(dem, 1, dem_spins).x, 1e-9 * spin);
    }
    assert_close(most, 0.5 * spin * stop, 0.005);
    assert_true(fabs(of_grain(dem, 0, dem_spins).x) < 0.05 * spin);
    dem_free(dem);
    packing_free(&scene.packing);
}

TEST(turn_against_each_other)
{
    for (int law = DEM_LINEAR; law <= DEM_HERTZ; law++) {
        turn_against((enum dem_law)law, true);
        turn_against((enum dem_law)law, false);
    }
}

// Nothing resists grains that turn about the line between them.
TEST(twist_is_free)
{
    const struct vector position[2] = {{0, 0, 0}, {0, 0, 1.99 * GRAIN}};
    struct scene scene;
    set_scene(&scene, 2, position, 0, NULL);
    resist(&scene, 0.3);
    struct dem *dem = create(&scene.setup);
    dem_set_velocity(dem, NULL, (struct vector[2]){{0, 0, 3}, {0, 0, -5}});
    run(dem, 20);
    assert_near(of_grain(dem, 0, dem_spins), (struct vector){0, 0, 3}, 1e-13);
    assert_near(of_grain(dem, 1, dem_spins), (struct vector){0, 0, -5}, 1e-13);
    dem_free(dem);
    packing_free(&scene.packing);
}

enum { SIDE = 5, N = SIDE * SIDE * SIDE };

// Grains that overlap and fly about, of one radius or of two.
static struct dem *cloud(struct scene *scene, enum dem_law law, bool two)
{
    struct vector position[N];
    for (int i = 0; i < N; i++)
        position[i] = scale(1.95 * GRAIN, (struct vector){i % SIDE, i / SIDE % SIDE,
                                                          i / (SIDE * SIDE)});
    set_scene(scene, N, position, 0, NULL);
    for (int i = 0; i < N && two; i++)
        scene->packing.radius[i] *= i % 3 ? 1 : 0.97;
    resist(scene, 0.3);
    scene->setup.law = law;
    scene->setup.material.contact_time = 5e-4;
    scene->setup.material.restitution = 0.8;
    scene->setup.largest_overlap = 0.1;
    struct dem *dem = create(&scene->setup);
    struct vector *velocity = random_vectors(N, 0.1, 1);
    struct vector *spin = random_vectors(N, 0.1 / GRAIN, 2);
    dem_set_velocity(dem, velocity, spin);
    free(velocity);
    free(spin);
    return dem;
}

// Moments are opposite: a cloud keeps both momenta.
TEST(keeps_momentum)
{
    for (int k = 0; k < 6; k++) {
        struct scene scene;
        struct dem *dem = cloud(&scene, (enum dem_law)(k / 2), k % 2);
        const struct dem_momentum before = dem_momentum(dem);
        run(dem, 100);
        const struct dem_momentum after = dem_momentum(dem);
        const double size = N * mass() * 0.1;
        assert_near(after.linear, before.linear, 1e-14 * size);
        assert_near(after.angular, before.angular, 1e-13 * size * SIDE * GRAIN);
        dem_free(dem);
        packing_free(&scene.packing);
    }
}

// Stiff rolling springs decide the step: with k_r = 2.25 k_n mu_r^2 R*^2 between two
// grains and no friction the fastest mode is that of two that turn against each other.
TEST(limit_of_the_step)
{
    const struct vector position[2] = {{0, 0, 0}, {0, 0, 2 * GRAIN - 1e-7}};
    struct scene scene;
    set_scene(&scene, 2, position, 0, NULL);
    resist(&scene, 0);
    scene.setup.material.friction = 0;
    scene.setup.material.damping_ratio = 0;
    scene.setup.material.rolling_friction = 20;
    const double arm = 20 * 0.5 * GRAIN, k = 2.25 * 500 * arm * arm;
    const double limit = 2 / sqrt(2 * k / (0.4 * mass() * GRAIN * GRAIN));
    for (int past = 0; past < 2; past++) {
        scene.setup.time_step = limit * (past ? 1.02 : 0.98);
        scene.setup.force_time_step = true;
        struct dem *dem = create(&scene.setup);
        assert_close(dem_time_step_limit(dem), limit, 3e-3);
        dem_set_velocity(dem, NULL, (struct vector[2]){{1e-6, 0, 0}, {-1e-6, 0, 0}});
        double most = 0;
        for (int c = 0; c < 60; c++) {
            run(dem, 1);
            most = fmax(most, fabs(of_grain(dem, 0, dem_spins).x));
        }
        assert_true(past ? most > 1e-3 : most < 2e-5);
        dem_free(dem);
    }
    packing_free(&scene.packing);
}

// 4 and 8 pairs at once, of one radius and of many, with each law.
TEST_WHERE(has_avx512(), "no AVX-512", width_makes_no_difference)
{
    for (int k = 0; k < 6; k++) {
        struct scene scene;
        struct dem *dem[2];
        for (int wide = 0; wide < 2; wide++) {
            dem[wide] = cloud(&scene, (enum dem_law)(k / 2), k % 2);
            const unsigned features = dem[wide]->features;
            dem[wide]->sweep =
                wide ? pair_sweeps_avx512[features] : pair_sweeps_avx2[features];
            run(dem[wide], 100);
            if (!wide) packing_free(&scene.packing);
        }
        const size_t n = (size_t)scene.packing.n_particle;
        assert_memory_equal(dem[0]->place, dem[1]->place, n * sizeof *dem[0]->place);
        assert_memory_equal(dem[0]->velocity, dem[1]->velocity, 8 * n * sizeof(double));
        dem_free(dem[0]);
        dem_free(dem[1]);
        packing_free(&scene.packing);
    }
}

TEST(refuses_what_it_cannot)
{
    struct packing packing = bonded_pair();
    struct dem_setup setup = stiff_setup(&packing);
    setup.material.rolling_friction = 0.1;
    assert_refused(setup, "does not go with bonds");
    setup.material.rolling_friction = -0.1;
    assert_refused(setup, "rolling friction must be >= 0, got -0.1");
    setup.material.rolling_friction = 0;
    const double pairs = INFINITY;
    setup.pair_rolling_friction = &pairs;
    assert_refused(setup, "materials 0 and 0: rolling friction");
    packing_free(&packing);
}
