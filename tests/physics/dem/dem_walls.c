// SPDX-License-Identifier: GPL-3.0-or-later
// Walls of every shape: where they touch grains, and with what force.
#include "wall_scene.h"

// Walls under a grain about the origin that touches them at its lowest point or, where
// grains are outside, balances on top.
static const struct vector beneath = {0, 0, -GRAIN};
static const struct dem_wall supports[] = {
    {.shape = DEM_PLANE, .point = {0.3, 0.2, -GRAIN}, .normal = {0, 0, 2}},
    {.shape = DEM_CYLINDER, .point = {1, 0, 4e-3}, .normal = {3, 0, 0}, .radius = 5e-3},
    {.shape = DEM_CYLINDER,
     .point = {1, 0, -8e-3},
     .normal = {1, 0, 0},
     .radius = 7e-3,
     .outside = true},
    {.shape = DEM_SPHERE, .point = {0, 0, 4e-3}, .radius = 5e-3},
    {.shape = DEM_SPHERE, .point = {0, 0, -8e-3}, .radius = 7e-3, .outside = true},
    {.shape = DEM_RING,
     .point = {-0.05, 0, -GRAIN},
     .normal = {0, 0, 1},
     .radius = 0.1},
    {.shape = DEM_RING,
     .point = {-0.05, 0, -GRAIN},
     .normal = {0, 0, -1},
     .radius = 0.1,
     .inner_radius = 0.04},
    {.shape = DEM_RING, // on its rim
     .point = {0, 0, -0.1 - GRAIN},
     .normal = {0, 1, 0},
     .radius = 0.1,
     .inner_radius = 0.04},
    {.shape = DEM_BLOCK, .point = {0.1, 0, -3e-3}, .half_edge = {0.2, 0.1, 2e-3}},
};
enum { N_SUPPORT = sizeof supports / sizeof *supports };

static void rest_on(const struct dem_wall *wall, enum dem_law law, double friction)
{
    const struct vector origin = {0, 0, 0};
    struct scene scene;
    set_scene(&scene, 1, &origin, 1, wall);
    scene.setup.law = law;
    scene.setup.material.friction = friction;
    scene.setup.material.damping_ratio = 0.5;
    scene.setup.material.restitution = 0.2;
    scene.setup.gravity.z = -gravity;
    struct dem *dem = create(&scene.setup);
    settle(dem, 1e-9);
    run(dem, 1);
    const struct vector force = {0, 0, -weight()};
    const struct vector lever = subtract(beneath, wall->point);
    const struct dem_wall_state state = dem_wall_state(dem, 0);
    assert_near(state.force, force, 1e-6 * weight());
    assert_near(state.moment, cross(lever, force),
                1e-6 * weight() * (norm(lever) + GRAIN));
    dem_free(dem);
    packing_free(&scene.packing);
}

TEST(walls_carry_weight)
{
    for (int w = 0; w < N_SUPPORT; w++)
        for (int k = 0; k < 2; k++) {
            rest_on(&supports[w], DEM_LINEAR, 0.4 * k);
            rest_on(&supports[w], DEM_HERTZ, 0.4 * k);
        }
}

// An overlap of 1e-9 radii on what is flat or round.
TEST(light_touch)
{
    const struct vector origin = {0, 0, 0};
    for (int w = 0; w < 5; w++) {
        struct scene scene;
        set_scene(&scene, 1, &origin, 1, &supports[w]);
        scene.setup.material.damping_ratio = 0.5;
        const double force = 1e-9 * GRAIN * stiffness;
        scene.setup.gravity.z = -force / mass();
        struct dem *dem = create(&scene.setup);
        settle(dem, 1e-9);
        run(dem, 1);
        assert_near(dem_wall_state(dem, 0).force, (struct vector){0, 0, -force},
                    1e-6 * force);
        assert_close(-displacement_of(dem, 0).z, 1e-9 * GRAIN, 1e-6);
        dem_free(dem);
        packing_free(&scene.packing);
    }
}

// The way grain I is pushed by a wall and its overlap.
static void check_touch(const struct dem_wall *wall, struct vector position,
                        struct vector normal, double overlap)
{
    struct scene scene;
    set_scene(&scene, 1, &position, 1, wall);
    scene.setup.time_step_safety = 1e-6; // deep overlaps throw far
    struct dem *dem = create(&scene.setup);
    run(dem, 1);
    const double size = stiffness * overlap;
    assert_near(dem_wall_state(dem, 0).force, scale(size, normal), 1e-9 * size);
    assert_near(of_grain(dem, 0, dem_velocities),
                scale(-size * dem_time_step(dem) / mass(), normal),
                1e-9 * size * dem_time_step(dem) / mass());
    dem_free(dem);
    packing_free(&scene.packing);
}

TEST(block_pushes_from_the_nearest_point)
{
    const struct dem_wall block = {.shape = DEM_BLOCK,
                                   .point = {1e-2, 2e-2, 3e-2},
                                   .half_edge = {2e-3, 3e-3, 4e-3}};
    for (int k = 1; k < 27; k++) { // faces, edges and corners
        const struct vector side = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
        if (norm(side) <= 0) continue;
        const struct vector surface = {side.x * 2e-3, side.y * 3e-3, side.z * 4e-3};
        const struct vector out = scale(1 / norm(side), side);
        const double away = 0.9 * GRAIN;
        const struct vector position = add(add(block.point, surface), scale(away, out));
        check_touch(&block, position, scale(-1, out), GRAIN - away);
    }
    // Inside, the nearest face.
    check_touch(&block, add(block.point, (struct vector){-1.9e-3, 0, 0}),
                (struct vector){1, 0, 0}, GRAIN + 0.1e-3);
    check_touch(&block, add(block.point, (struct vector){0.1e-3, 2.8e-3, -2e-3}),
                (struct vector){0, -1, 0}, GRAIN + 0.2e-3);
}

TEST(ring_pushes_from_the_nearest_point)
{
    const struct dem_wall ring = {
        .shape = DEM_RING, .normal = {0, 0, 1}, .radius = 9e-3, .inner_radius = 4e-3};
    const double half = 0.5 * GRAIN;
    check_touch(&ring, (struct vector){0, 6e-3, half}, (struct vector){0, 0, -1}, half);
    check_touch(&ring, (struct vector){0, 6e-3, -half}, (struct vector){0, 0, 1}, half);
    // In its plane, beyond the outer rim and within the inner one.
    check_touch(&ring, (struct vector){0, 9e-3 + half, 0}, (struct vector){0, -1, 0},
                half);
    check_touch(&ring, (struct vector){-4e-3 + half, 0, 0}, (struct vector){-1, 0, 0},
                half);
    check_touch(&ring, (struct vector){0, 9e-3 + 0.3 * GRAIN, 0.4 * GRAIN},
                (struct vector){0, -0.6, -0.8}, half);
}

// Centres where no direction is nearest.
TEST(degenerate_centres)
{
    const struct vector origin = {0, 0, 0};
    const struct dem_wall walls[] = {
        {.shape = DEM_CYLINDER, .normal = {1, 1, 1}, .radius = 1e-4, .outside = true},
        {.shape = DEM_CYLINDER, .normal = {1, 0, 0}, .radius = 5e-4},
        {.shape = DEM_SPHERE, .radius = 1e-4, .outside = true},
        {.shape = DEM_SPHERE, .radius = 5e-4},
        {.shape = DEM_RING, .normal = {0, 0, 1}, .radius = 1},
        {.shape = DEM_RING, .normal = {0, 1, 1}, .radius = 1, .inner_radius = 5e-4},
        {.shape = DEM_BLOCK, .half_edge = {1e-4, 1e-4, 1e-4}}};
    const double overlap[] = {1.1e-3, 0.5e-3, 1.1e-3, 0.5e-3, 1e-3, 0.5e-3, 1.1e-3};
    for (int w = 0; w < (int)(sizeof walls / sizeof *walls); w++) {
        struct scene scene;
        set_scene(&scene, 1, &origin, 1, &walls[w]);
        scene.setup.time_step_safety = 1e-6;
        struct dem *dem = create(&scene.setup);
        run(dem, 1);
        assert_close(norm(dem_wall_state(dem, 0).force), stiffness * overlap[w], 1e-12);
        dem_free(dem);
        packing_free(&scene.packing);
    }
}

// A search in between changes not a byte.
TEST(searches_leave_history)
{
    struct vector end[2];
    for (int k = 0; k < 2; k++) {
        const struct vector position = {4e-3, -0.5e-3, -2.93e-3};
        const struct vector velocity = {0.05, 0.1, 0.02}, spin = {10, 20, 30};
        const struct dem_wall walls[] = {
            {.shape = DEM_SPHERE, .radius = 6e-3, .spin = {1, 2, 3}},
            {.point = {0, 0, -4e-3}, .normal = {0, 0, 1}}};
        struct scene scene;
        set_scene(&scene, 1, &position, 2, walls);
        scene.setup.law = DEM_HERTZ;
        scene.setup.material.friction = 0.5;
        scene.setup.material.restitution = 0.5;
        scene.setup.gravity.z = -gravity;
        struct dem *dem = create(&scene.setup);
        dem_set_velocity(dem, &velocity, &spin);
        int64_t touching = 0;
        for (int step = 0; step < 5000; step++) {
            run(dem, 1);
            touching += norm(dem_wall_state(dem, 0).force) > 0;
            if (k == 1) find_pairs(dem);
        }
        assert_true(touching > 500);
        end[k] = of_grain(dem, 0, dem_positions);
        dem_free(dem);
        packing_free(&scene.packing);
    }
    assert_memory_equal(&end[0], &end[1], sizeof end[0]);
}

// When the grain first feels a wall, s.
static double first_touch(struct dem *dem)
{
    while (dem_cycle(dem) < 1000000 && norm(dem_wall_state(dem, 0).force) <= 0)
        run(dem, 1);
    return (double)(dem_cycle(dem) - 1) * dem_time_step(dem);
}

// Walls that come from afar, from any side, are noticed in time.
TEST(walls_arrive)
{
    const struct vector origin = {0, 0, 0};
    const struct dem_wall walls[] = {
        {.point = {0, 0, -6e-3}, .normal = {0, 0, 1}},
        {.shape = DEM_CYLINDER, .normal = {0, 1, 0}, .radius = 6e-3},
        {.shape = DEM_SPHERE, .point = {0, 0, -8e-3}, .radius = 2e-3, .outside = true},
        {.shape = DEM_RING,
         .point = {0, 1e-3, -6e-3},
         .normal = {0, 0, 1},
         .radius = 2e-3},
        {.shape = DEM_BLOCK, .point = {0, 0, -7e-3}, .half_edge = {1e-3, 1e-3, 1e-3}}};
    for (int w = 0; w < 5; w++) {
        struct dem_wall wall = walls[w];
        wall.velocity.z = 0.1;
        struct scene scene;
        set_scene(&scene, 1, &origin, 1, &wall);
        struct dem *dem = create(&scene.setup);
        const double dt = dem_time_step(dem);
        assert_true(fabs(first_touch(dem) - (6e-3 - GRAIN) / 0.1) < 1.01 * dt);
        dem_free(dem);
        packing_free(&scene.packing);
    }
}

// A grain that leaves a block by one side and comes back, where the box repeats, by the
// other.
TEST(box_repeats)
{
    const struct vector position = {7e-3, 5e-3, 5e-3}, velocity = {0.1, 0, 0};
    const struct dem_wall block = {.shape = DEM_BLOCK,
                                   .point = {5e-3, 5e-3, 5e-3},
                                   .half_edge = {1e-3, 1e-3, 1e-3}};
    struct scene scene;
    set_scene(&scene, 1, &position, 1, &block);
    scene.packing.periodic[0] = 1;
    scene.packing.upper = (struct vector){1e-2, 1e-2, 1e-2};
    struct dem *dem = create(&scene.setup);
    dem_set_velocity(dem, &velocity, NULL);
    run(dem, 2); // touches the block at first, with no overlap
    const double dt = dem_time_step(dem);
    while (of_grain(dem, 0, dem_positions).x < 12e-3)
        run(dem, 1);
    assert_true(fabs(first_touch(dem) - 6e-3 / 0.1) < 1.01 * dt);
    run(dem, 10);
    assert_true(dem_wall_state(dem, 0).force.x > 0);
    dem_free(dem);
    packing_free(&scene.packing);
}
