// SPDX-License-Identifier: GPL-3.0-or-later
// Walls that move, turn and are under servo control, against closed forms.
#include "wall_scene.h"

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
TEST(turntable_drags)
{
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
TEST(turntable_rolling)
{
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

TEST(servo)
{
    press_column(DEM_LINEAR, 0.01);
    press_column(DEM_HERTZ, 0.01);
}

// Near the limit of the time step, without damping and with much of it.
TEST(servo_is_stable)
{
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
TEST(compression)
{
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

// A grain held between two planes that turn with it, on the axis, swings sideways on
// their shear springs as if nothing turned: the springs take part in the turning.
TEST(springs_turn_along)
{
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
TEST(hertz_shear)
{
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
TEST(contact_of_a_moving_wall)
{
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
