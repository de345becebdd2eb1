// SPDX-License-Identifier: GPL-3.0-or-later
// Walls of every shape, at rest, moving, turning and under servo control, against
// closed forms and conservation.
#include "dem_scene.h"

#define GRAIN 1e-3 // m
static const double density = 2500, stiffness = 1000, gravity = 9.81;

struct scene {
    struct packing packing;
    struct dem_setup setup;
};

// Grains at rest at POSITION among walls; undamped, without friction.
static void set_scene(struct scene *scene, int n_grain, const struct vector *position,
                      int n_wall, const struct dem_wall *wall)
{
    scene->packing = new_packing(n_grain, 0);
    scene->packing.upper = (struct vector){1, 1, 1};
    for (int i = 0; i < n_grain; i++) {
        scene->packing.position[i] = position[i];
        scene->packing.radius[i] = GRAIN;
    }
    scene->setup = (struct dem_setup){.packing = &scene->packing,
                                      .material = {.density = density,
                                                   .normal_stiffness = stiffness,
                                                   .shear_stiffness = 0.8 * stiffness,
                                                   .young_modulus = 1e7,
                                                   .poisson_ratio = 0.3,
                                                   .restitution = 1},
                                      .n_wall = n_wall,
                                      .wall = wall,
                                      .time_step_safety = 0.05,
                                      .balance_energy = true,
                                      .threads = 1};
}

static double mass(void)
{
    return density * 4.0 / 3 * M_PI * GRAIN * GRAIN * GRAIN;
}

static double weight(void)
{
    return mass() * gravity;
}

static struct vector of_grain(const struct dem *dem, int grain,
                              void (*ask)(const struct dem *, struct vector *))
{
    struct vector *all = NEW_ARRAY(struct vector, dem->n_particle);
    ask(dem, all);
    const struct vector one = all[grain];
    free(all);
    return one;
}

static void assert_near(struct vector got, struct vector wanted, double within)
{
    if (!(distance(got, wanted) <= within))
        fail_msg("got (%.12g, %.12g, %.12g), wanted (%.12g, %.12g, %.12g) within %g",
                 got.x, got.y, got.z, wanted.x, wanted.y, wanted.z, within);
}

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

static void test_walls_carry_weight(void **state)
{
    (void)state;
    for (int w = 0; w < N_SUPPORT; w++)
        for (int k = 0; k < 2; k++) {
            rest_on(&supports[w], DEM_LINEAR, 0.4 * k);
            rest_on(&supports[w], DEM_HERTZ, 0.4 * k);
        }
}

// An overlap of 1e-9 radii on what is flat or round.
static void test_light_touch(void **state)
{
    (void)state;
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

// What is left of the speed after a blow on a plane, and how long it took.
struct rebound {
    double ratio, time;
};

static struct rebound rebound(double restitution, double contact_time, int steps)
{
    const struct vector position = {0, 0, 1.01 * GRAIN};
    const struct dem_wall floor = {.normal = {0, 0, 1}};
    struct scene scene;
    set_scene(&scene, 1, &position, 1, &floor);
    scene.setup.law = DEM_TIMED;
    scene.setup.material.restitution = restitution;
    scene.setup.material.contact_time = contact_time;
    scene.setup.time_step = contact_time / steps;
    struct dem *dem = create(&scene.setup);
    const struct vector velocity = {0, 0, -0.1};
    dem_set_velocity(dem, &velocity, NULL);
    int touching = 0;
    for (int k = 0; k < 4 * steps; k++) {
        run(dem, 1);
        touching += norm(dem_wall_state(dem, 0).force) > 0;
    }
    const struct rebound found = {of_grain(dem, 0, dem_velocities).z / 0.1,
                                  touching * dem_time_step(dem)};
    dem_free(dem);
    packing_free(&scene.packing);
    return found;
}

static void test_rebound(void **state)
{
    (void)state;
    for (int k = 2; k <= 10; k += 2) {
        const double e = 0.1 * k, t = 1e-4;
        const struct rebound coarse = rebound(e, t, 200), fine = rebound(e, t, 2000);
        assert_close(coarse.ratio, e, 5e-3);
        assert_close(fine.ratio, e, 5e-4);
        assert_close(fine.time, t, 1e-3);
    }
}

// The time of TURNS swings of a grain in a trough or bowl of radius 10 mm about the
// origin, from 0.1 rad; by when it passes the lowest point.
static double swing(enum dem_wall_shape shape, double friction, int turns)
{
    const double track = 10e-3 - GRAIN, angle = 0.1;
    const struct dem_wall wall = {
        .shape = shape, .normal = {0, 1, 0}, .radius = track + GRAIN};
    const double overlap = weight() * cos(angle) / (100 * stiffness);
    const struct vector position = {(track + overlap) * sin(angle), 0,
                                    -(track + overlap) * cos(angle)};
    struct scene scene;
    set_scene(&scene, 1, &position, 1, &wall);
    scene.setup.material.normal_stiffness = 100 * stiffness;
    scene.setup.material.shear_stiffness = 80 * stiffness;
    scene.setup.material.friction = friction;
    scene.setup.gravity.z = -gravity;
    scene.setup.time_step_safety = 0.2;
    struct dem *dem = create(&scene.setup);
    double before = position.x, first = 0;
    for (int passes = 0;;) {
        run(dem, 1);
        const double x = of_grain(dem, 0, dem_positions).x;
        const bool passed = before > 0 && x <= 0;
        const double dt = dem_time_step(dem);
        const double now = (double)dem_cycle(dem) * dt - dt * x / (x - before);
        before = x;
        if (!passed) continue;
        if (passes == 0) first = now;
        if (passes++ < turns) continue;
        dem_free(dem);
        packing_free(&scene.packing);
        return (now - first) / turns;
    }
}

// A body that slides in a bowl swings as a pendulum does; a ball that rolls, slower by
// sqrt(7/5).
static void test_pendulum(void **state)
{
    (void)state;
    const double track = 10e-3 - GRAIN, angle = 0.1;
    const double period = 2 * M_PI * sqrt(track / gravity) * (1 + angle * angle / 16);
    const enum dem_wall_shape shapes[] = {DEM_CYLINDER, DEM_SPHERE};
    for (int k = 0; k < 2; k++) {
        assert_close(swing(shapes[k], 0, 2), period, 1e-5);
        assert_close(swing(shapes[k], 0.5, 2), period * sqrt(1.4), 1e-5);
    }
}

// A grain on a turning disc or ring.
static struct dem *turntable(struct scene *scene, struct dem_wall *table, double at,
                             double rate)
{
    *table = (struct dem_wall){.shape = DEM_RING,
                               .normal = {0, 0, 1},
                               .radius = 0.1,
                               .inner_radius = 0.5 * at,
                               .spin = {0, 0, rate}};
    const struct vector position = {at, 0, GRAIN - weight() / stiffness};
    set_scene(scene, 1, &position, 1, table);
    scene->setup.material.friction = 0.3;
    scene->setup.material.damping_ratio = 0.3;
    scene->setup.gravity.z = -gravity;
    return create(&scene->setup);
}

// It slides at first: friction drags it along and brakes the table.
static void test_turntable_drags(void **state)
{
    (void)state;
    const double at = 0.05, rate = 40, force = 0.3 * weight();
    struct scene scene;
    struct dem_wall table;
    struct dem *dem = turntable(&scene, &table, at, 0);
    run(dem, 1);
    dem_set_wall_motion(dem, 0, (struct vector){0, 0, 0}, (struct vector){0, 0, rate});
    run(dem, 1000);
    const double time = 999 * dem_time_step(dem);
    const struct dem_wall_state load = dem_wall_state(dem, 0);
    assert_close(load.moment.z, -force * at, 1e-4);
    assert_close(of_grain(dem, 0, dem_velocities).y, 0.3 * gravity * time, 2e-3);
    assert_close(of_grain(dem, 0, dem_spins).x,
                 force * GRAIN / (0.4 * mass() * GRAIN * GRAIN) * time, 2e-3);

    // The work of the table is motion and what was lost on the way.
    const struct dem_energy energy = dem_energy(dem);
    assert_true(energy.slip > 0.5 * energy.gained);
    assert_close(energy.kinetic + energy.elastic + energy.slip + energy.dashpots,
                 energy.gained + weight() * weight() / (2 * stiffness), 1e-6);
    dem_free(dem);
    packing_free(&scene.packing);
}

// A ball that rolls on a turntable goes round in circles at 2/7 of its rate, wherever
// their centre.
static void test_turntable_rolling(void **state)
{
    (void)state;
    const double at = 0.05, rate = 10, speed = 0.02;
    struct scene scene;
    struct dem_wall table;
    struct dem *dem = turntable(&scene, &table, at, rate);
    // v + spin x (0, 0, -R) = (0, rate at, 0)
    const double arm = GRAIN - 0.5 * weight() / stiffness;
    const struct vector velocity = {speed, 0, 0},
                        spin = {rate * at / arm, speed / arm, 0};
    dem_set_velocity(dem, &velocity, &spin);
    const double quarter = 0.5 * M_PI / (2.0 / 7 * rate);
    const double radius = speed / (2.0 / 7 * rate);
    const struct vector wanted[] = {
        {radius, radius, 0}, {0, 2 * radius, 0}, {-radius, radius, 0}, {0, 0, 0}};
    for (int k = 0; k < 4; k++) {
        const double until = (k + 1) * quarter / dem_time_step(dem);
        run(dem, (int64_t)rint(until) - dem_cycle(dem));
        struct vector moved = displacement_of(dem, 0);
        moved.z = 0;
        assert_near(moved, wanted[k], 1e-3 * radius);
    }
    dem_free(dem);
    packing_free(&scene.packing);
}

// A servo comes down on a column and presses it against the floor.
static void press_column(enum dem_law law, double target)
{
    struct vector position[3];
    for (int i = 0; i < 3; i++)
        position[i] = (struct vector){0, 0, (2 * i + 1) * GRAIN};
    const struct dem_wall walls[] = {{.normal = {0, 0, 1}},
                                     {.point = {0, 0, 6.05 * GRAIN},
                                      .normal = {0, 0, -1},
                                      .servo_force = target,
                                      .servo_largest_speed = 0.05}};
    struct scene scene;
    set_scene(&scene, 3, position, 2, walls);
    scene.setup.law = law;
    scene.setup.material.damping_ratio = 0.3;
    scene.setup.material.restitution = 0.3;
    struct dem *dem = create(&scene.setup);
    run(dem, 20000);
    const struct vector force = {0, 0, target};
    assert_near(dem_wall_state(dem, 1).force, force, 1e-3 * target);
    assert_near(dem_wall_state(dem, 0).force, scale(-1, force), 1e-3 * target);
    assert_true(dem_wall_state(dem, 1).displacement.z < -0.05 * GRAIN);
    // Half of it: the wall backs off.
    const double before = dem_wall_state(dem, 1).displacement.z;
    dem_set_servo(dem, 1, 0.5 * target);
    run(dem, 20000);
    assert_near(dem_wall_state(dem, 0).force, scale(-0.5, force), 1e-3 * target);
    assert_true(dem_wall_state(dem, 1).displacement.z > before);
    dem_free(dem);
    packing_free(&scene.packing);
}

static void test_servo(void **state)
{
    (void)state;
    press_column(DEM_LINEAR, 0.01);
    press_column(DEM_HERTZ, 0.01);
}

// Near the limit of the time step, without damping and with much of it.
static void test_servo_is_stable(void **state)
{
    (void)state;
    const struct vector origin = {0, 0, 0};
    const struct dem_wall walls[] = {{.point = {0, 0, -GRAIN}, .normal = {0, 0, 1}},
                                     {.point = {0, 0, GRAIN},
                                      .normal = {0, 0, -1},
                                      .servo_force = 0.01,
                                      .servo_largest_speed = 0.05}};
    for (int k = 0; k < 3; k++) {
        struct scene scene;
        set_scene(&scene, 1, &origin, 2, walls);
        scene.setup.material.damping_ratio = 0.7 * k;
        scene.setup.time_step_safety = 1e-3;
        struct dem *dem = create(&scene.setup);
        scene.setup.time_step = 0.8 * dem_time_step_limit(dem);
        dem_free(dem);
        dem = create(&scene.setup);
        run(dem, 30000);
        assert_near(dem_wall_state(dem, 0).force, (struct vector){0, 0, -0.01}, 1e-5);
        dem_free(dem);
        packing_free(&scene.packing);
    }
}

// Two walls that close on a grain: each spring takes half of the way, and the work of
// the wall is all there is.
static void test_compression(void **state)
{
    (void)state;
    const struct vector origin = {0, 0, 0};
    const struct dem_wall walls[] = {
        {.point = {0, 0, -GRAIN}, .normal = {0, 0, 1}},
        {.point = {0, 0, GRAIN}, .normal = {0, 0, -1}, .velocity = {0, 0, -1e-3}}};
    struct scene scene;
    set_scene(&scene, 1, &origin, 2, walls);
    scene.setup.material.damping_ratio = 0.2;
    struct dem *dem = create(&scene.setup);
    const int64_t steps = (int64_t)rint(0.02 / dem_time_step(dem));
    run(dem, steps);
    dem_set_wall_motion(dem, 1, (struct vector){0, 0, 0}, (struct vector){0, 0, 0});
    settle(dem, 1e-9);
    const double way = -dem_wall_state(dem, 1).displacement.z;
    assert_close(way, 1e-3 * (double)steps * dem_time_step(dem), 1e-12);
    const struct vector force = {0, 0, 0.5 * stiffness * way};
    assert_near(dem_wall_state(dem, 1).force, force, 1e-6 * force.z);
    assert_near(dem_wall_state(dem, 0).force, scale(-1, force), 1e-6 * force.z);
    const struct dem_energy energy = dem_energy(dem);
    assert_close(energy.elastic, 0.25 * stiffness * way * way, 1e-6);
    assert_close(energy.kinetic + energy.elastic + energy.dashpots, energy.gained,
                 1e-5);
    dem_free(dem);
    packing_free(&scene.packing);
}

static const struct dem_wall box_of_walls[] = {
    {.point = {0, 0, 0}, .normal = {1, 0, 0}},
    {.point = {8e-3, 0, 0}, .normal = {-1, 0.1, 0}},
    {.point = {0, 0, 0}, .normal = {0, 1, 0}},
    {.point = {0, 8e-3, 0}, .normal = {0, -1, 0}, .velocity = {0.02, -0.1, 0}},
    {.point = {0, 0, 0}, .normal = {0, 0, 1}, .spin = {0, 0, 100}},
    {.shape = DEM_CYLINDER,
     .point = {0, 4e-3, 4e-3},
     .normal = {1, 0, 0},
     .radius = 4.5e-3,
     .spin = {-50, 0, 0}},
    {.shape = DEM_SPHERE,
     .point = {3e-3, 3e-3, 9e-3},
     .radius = 1e-3,
     .outside = true,
     .spin = {30, 200, 10}},
    {.shape = DEM_RING,
     .point = {4e-3, 4e-3, 4e-3},
     .normal = {1, 2, 3},
     .radius = 1.5e-3,
     .inner_radius = 1e-3,
     .spin = {100, 200, 300}},
    {.shape = DEM_BLOCK,
     .point = {0, 0, 0},
     .half_edge = {1e-3, 1e-3, 1e-3},
     .velocity = {0.05, 0.05, 0.05}}};
enum { N_BOX = sizeof box_of_walls / sizeof *box_of_walls };

// What walls do to grains is the change of their momentum, and of their angular
// momentum, in every time step.
static void test_momentum(void **state)
{
    (void)state;
    struct vector position[27];
    for (int i = 0; i < 27; i++)
        position[i] = (struct vector){(1.6 + 2.4 * (i % 3)) * GRAIN,
                                      (1.6 + 2.4 * (i / 3 % 3)) * GRAIN,
                                      (1.6 + 2.4 * (i / 9)) * GRAIN};
    for (enum dem_law law = DEM_LINEAR; law <= DEM_HERTZ; law += 2) {
        struct scene scene;
        set_scene(&scene, 27, position, N_BOX, box_of_walls);
        scene.setup.law = law;
        scene.setup.material.friction = 0.4;
        scene.setup.material.damping_ratio = 0.2;
        scene.setup.material.restitution = 0.7;
        scene.setup.largest_overlap = 0.05;
        struct dem *dem = create(&scene.setup);
        struct vector *velocity = random_vectors(27, 0.2, 1);
        struct vector *spin = random_vectors(27, 200, 2);
        dem_set_velocity(dem, velocity, spin);
        free(velocity);
        free(spin);
        double largest = 0;
        for (int k = 0; k < 3000; k++) {
            const struct dem_momentum before = dem_momentum(dem);
            struct vector point[N_BOX];
            for (int w = 0; w < N_BOX; w++)
                point[w] =
                    add(box_of_walls[w].point, dem_wall_state(dem, w).displacement);
            run(dem, 1);
            const struct dem_momentum after = dem_momentum(dem);
            struct vector force = {0, 0, 0}, moment = {0, 0, 0};
            for (int w = 0; w < N_BOX; w++) {
                const struct dem_wall_state load = dem_wall_state(dem, w);
                force = add(force, load.force);
                moment = add(moment, add(load.moment, cross(point[w], load.force)));
            }
            const double dt = -dem_time_step(dem);
            const double scale_of = 27 * mass() * 0.2;
            assert_near(subtract(after.linear, before.linear), scale(dt, force),
                        1e-13 * scale_of);
            assert_near(subtract(after.angular, before.angular), scale(dt, moment),
                        1e-13 * scale_of * 8e-3);
            largest = fmax(largest, norm(force));
        }
        assert_true(largest > 0.01 * stiffness * GRAIN * 0.1);
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

static void test_block_pushes_from_the_nearest_point(void **state)
{
    (void)state;
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

static void test_ring_pushes_from_the_nearest_point(void **state)
{
    (void)state;
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
static void test_degenerate_centres(void **state)
{
    (void)state;
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

// A grain that bounces without loss about a hollow sphere, for 1e5 steps; RING: off the
// rims of a ring in its middle too. How far its energy strays, over what it began with.
static double bounce(enum dem_law law, double friction, bool ring, double safety)
{
    const struct vector position = {0.7e-3, -2.1e-3, 2.3e-3};
    const struct vector velocity = {0.07, 0.13, -0.16}, spin = {0, 100, 0};
    const struct dem_wall walls[] = {{.shape = DEM_SPHERE, .radius = 6e-3},
                                     {.shape = DEM_RING,
                                      .normal = {0.2, 0.1, 1},
                                      .radius = 1.5e-3,
                                      .inner_radius = 1.2e-3}};
    struct scene scene;
    set_scene(&scene, 1, &position, ring ? 2 : 1, walls);
    scene.setup.law = law;
    scene.setup.material.friction = friction;
    scene.setup.largest_overlap = 0.02;
    scene.setup.time_step_safety = safety;
    struct dem *dem = create(&scene.setup);
    dem_set_velocity(dem, &velocity, &spin);
    run(dem, 1);
    const double start = dem_energy(dem).kinetic;
    double furthest = 0, touches = 0;
    for (int k = 0; k < 100000; k++) {
        run(dem, 1);
        const struct dem_energy energy = dem_energy(dem);
        const double sum = energy.kinetic + energy.elastic + energy.slip;
        furthest = fmax(furthest, fabs(sum / start - 1));
        touches += norm(dem_wall_state(dem, ring).force) > 0;
    }
    assert_true(touches > 0);
    dem_free(dem);
    packing_free(&scene.packing);
    return furthest;
}

static void test_bouncing_keeps_its_energy(void **state)
{
    (void)state;
    for (enum dem_law law = DEM_LINEAR; law <= DEM_HERTZ; law += 2)
        for (int k = 0; k < 4; k++) {
            const double coarse = bounce(law, k / 2 ? 0.3 : 0, k % 2, 0.04);
            const double fine = bounce(law, k / 2 ? 0.3 : 0, k % 2, 0.01);
            assert_true(fine < 5e-4);
            assert_true(fine < 0.5 * coarse);
        }
}

// A search in between changes not a byte.
static void test_searches_leave_history(void **state)
{
    (void)state;
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
static void test_walls_arrive(void **state)
{
    (void)state;
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
static void test_box_repeats(void **state)
{
    (void)state;
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

// A blow by Hertz: the overlap goes to (15 m v^2 / (16 E* sqrt R))^(2/5) and
// lasts 2.9433 of what that takes at the first speed; against a rigid wall and one like
// the grain.
static void test_hertz_blow(void **state)
{
    (void)state;
    for (int material = 0; material < 2; material++) {
        const struct vector position = {0, 0, GRAIN}, velocity = {0, 0, -0.1};
        const struct dem_wall floor = {.normal = {0, 0, 1}, .material = material};
        struct scene scene;
        set_scene(&scene, 1, &position, 1, &floor);
        scene.setup.law = DEM_HERTZ;
        scene.setup.n_other = 1;
        scene.setup.other = &scene.setup.material;
        scene.setup.time_step_safety = 0.002;
        struct dem *dem = create(&scene.setup);
        dem_set_velocity(dem, &velocity, NULL);
        double deepest = 0, time = 0;
        do {
            run(dem, 1);
            deepest = fmax(deepest, -displacement_of(dem, 0).z);
            time += dem_time_step(dem);
        } while (displacement_of(dem, 0).z < 0);
        const double modulus = 1e7 / (1 - 0.09) / (1 + material);
        const double wanted =
            pow(15 * mass() * 0.01 / (16 * modulus * sqrt(GRAIN)), 0.4);
        assert_close(deepest, wanted, 1e-4);
        assert_close(time, 2.9433 * wanted / 0.1, 2e-3);
        assert_close(of_grain(dem, 0, dem_velocities).z, 0.1, 1e-4);
        dem_free(dem);
        packing_free(&scene.packing);
    }
}

// A grain held between two planes that turn with it, on the axis, swings sideways on
// their shear springs as if nothing turned: the springs take part in the turning.
static void test_springs_turn_along(void **state)
{
    (void)state;
    const struct vector origin = {0, 0, 0}, velocity = {1e-3, 0, 0}, spin = {0, 0, 300};
    const double squeeze = 0.01 * GRAIN;
    const struct dem_wall walls[] = {
        {.point = {0, 0, squeeze - GRAIN}, .normal = {0, 0, 1}, .spin = spin},
        {.point = {0, 0, GRAIN - squeeze}, .normal = {0, 0, -1}, .spin = spin}};
    struct scene scene;
    set_scene(&scene, 1, &origin, 2, walls);
    scene.setup.material.friction = 1;
    scene.setup.time_step_safety = 0.01;
    struct dem *dem = create(&scene.setup);
    dem_set_velocity(dem, &velocity, &spin);
    const double rate = sqrt(2 * 0.8 * stiffness / mass()), size = velocity.x / rate;
    double time = 0;
    for (int k = 0; k < 2000; k++) {
        run(dem, 1);
        time += dem_time_step(dem);
        const struct vector wanted = {size * sin(rate * time), 0, 0};
        // Of first order in how far they turn in one step.
        assert_near(displacement_of(dem, 0), wanted,
                    size * (spin.z * dem_time_step(dem) * rate * time + 2e-3));
    }
    assert_true(spin.z * time > 1);
    dem_free(dem);
    packing_free(&scene.packing);
}

static void move_wall(struct dem *dem, struct vector velocity, int steps)
{
    const struct vector none = {0, 0, 0};
    dem_set_wall_motion(dem, 0, velocity, none);
    run(dem, steps);
    dem_set_wall_motion(dem, 0, none, none);
    run(dem, 2);
}

// A wall that moves into a held grain, sideways, halfway out and in again. Hertz: shear
// force is 8 G* sqrt(R U) times the way, goes with sqrt(U) as the contact opens and
// stays as it closes. Both forces act at the middle of the overlap.
static void test_hertz_shear(void **state)
{
    (void)state;
    const struct vector origin = {0, 0, 0};
    const struct dem_wall floor = {.point = {1e-3, 0, -GRAIN}, .normal = {0, 0, 1}};
    const uint8_t fixed = 1;
    struct scene scene;
    set_scene(&scene, 1, &origin, 1, &floor);
    scene.setup.law = DEM_HERTZ;
    scene.setup.material.friction = 10;
    scene.setup.fixed = &fixed;
    struct dem *dem = create(&scene.setup);
    const double speed = 1e-8 / dem_time_step(dem), way = 1e-6;
    const double modulus = 1e7 / 0.91, shear_modulus = 1e7 / (2 * 1.7 * 1.3);
    const double moves[4][2] = {{0, 100}, {100, 0}, {0, -50}, {0, 50}};
    const double overlap[4] = {1e-6, 1e-6, 0.5e-6, 1e-6};
    const double share[4] = {0, 1, sqrt(0.5), sqrt(0.5)};
    for (int k = 0; k < 4; k++) {
        const double x = moves[k][0], z = moves[k][1], steps = fabs(x) + fabs(z);
        move_wall(dem, (struct vector){speed * x / steps, 0, speed * z / steps},
                  (int)steps);
        const struct dem_wall_state load = dem_wall_state(dem, 0);
        const double normal = -4.0 / 3 * modulus * sqrt(GRAIN) * pow(overlap[k], 1.5);
        const double shear = -8 * shear_modulus * sqrt(GRAIN * 1e-6) * way * share[k];
        const struct vector force = {shear, 0, normal};
        assert_near(load.force, force, 1e-6 * fabs(normal));
        const struct vector lever = {-1e-3 - load.displacement.x, 0, -0.5 * overlap[k]};
        assert_near(load.moment, cross(lever, force), 1e-6 * GRAIN * fabs(normal));
        const double arm = (load.moment.y + lever.x * load.force.z) / load.force.x;
        if (k > 0) assert_close(arm, lever.z, 1e-6);
    }
    dem_free(dem);
    packing_free(&scene.packing);
}

// Overlap and force of a contact are of the same moment while the wall moves.
static void test_contact_of_a_moving_wall(void **state)
{
    (void)state;
    const struct vector origin = {0, 0, 0};
    const struct dem_wall wall = {.shape = DEM_SPHERE,
                                  .point = {0, 0, -3e-3},
                                  .radius = 2e-3,
                                  .outside = true,
                                  .velocity = {0, 0, 0.1}};
    const uint8_t fixed = 1;
    struct scene scene;
    set_scene(&scene, 1, &origin, 1, &wall);
    scene.setup.fixed = &fixed;
    struct dem *dem = create(&scene.setup);
    run(dem, 20);
    int count;
    struct dem_contact *contact = dem_contacts(dem, &count);
    assert_int_equal(count, 1);
    assert_close(contact->overlap, 0.1 * 19 * dem_time_step(dem), 1e-9);
    assert_close(-contact->force.z, stiffness * contact->overlap, 1e-9);
    assert_near(contact->position,
                (struct vector){0, 0, 0.5 * contact->overlap - GRAIN}, 1e-12 * GRAIN);
    free(contact);
    dem_free(dem);
    packing_free(&scene.packing);
}

int main(void)
{
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_walls_carry_weight),
        cmocka_unit_test(test_light_touch),
        cmocka_unit_test(test_rebound),
        cmocka_unit_test(test_pendulum),
        cmocka_unit_test(test_turntable_drags),
        cmocka_unit_test(test_turntable_rolling),
        cmocka_unit_test(test_servo),
        cmocka_unit_test(test_servo_is_stable),
        cmocka_unit_test(test_compression),
        cmocka_unit_test(test_momentum),
        cmocka_unit_test(test_block_pushes_from_the_nearest_point),
        cmocka_unit_test(test_ring_pushes_from_the_nearest_point),
        cmocka_unit_test(test_degenerate_centres),
        cmocka_unit_test(test_bouncing_keeps_its_energy),
        cmocka_unit_test(test_searches_leave_history),
        cmocka_unit_test(test_walls_arrive),
        cmocka_unit_test(test_box_repeats),
        cmocka_unit_test(test_hertz_blow),
        cmocka_unit_test(test_springs_turn_along),
        cmocka_unit_test(test_hertz_shear),
        cmocka_unit_test(test_contact_of_a_moving_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
