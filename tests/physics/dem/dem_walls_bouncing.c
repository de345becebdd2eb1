// SPDX-License-Identifier: GPL-3.0-or-later
// Grains that bounce off walls, swing in them and are shaken between them, against
// closed forms and conservation.
#include "wall_scene.h"

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

TEST(rebound)
{
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
TEST(pendulum)
{
    const double track = 10e-3 - GRAIN, angle = 0.1;
    const double period = 2 * M_PI * sqrt(track / gravity) * (1 + angle * angle / 16);
    const enum dem_wall_shape shapes[] = {DEM_CYLINDER, DEM_SPHERE};
    for (int k = 0; k < 2; k++) {
        assert_close(swing(shapes[k], 0, 2), period, 1e-5);
        assert_close(swing(shapes[k], 0.5, 2), period * sqrt(1.4), 1e-5);
    }
}

// A blow by Hertz: the overlap goes to (15 m v^2 / (16 E* sqrt R))^(2/5) and
// lasts 2.9433 of what that takes at the first speed; against a rigid wall and one like
// the grain.
TEST(hertz_blow)
{
    for (int material = 0; material < 2; material++) {
        const struct vector position = {0, 0, GRAIN}, velocity = {0, 0, -0.1};
        const struct dem_wall floor = {
            .normal = {0, 0, 1}, .elastic = material > 0, .material = material};
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
TEST(momentum)
{
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

TEST(bouncing_keeps_its_energy)
{
    for (enum dem_law law = DEM_LINEAR; law <= DEM_HERTZ; law += 2)
        for (int k = 0; k < 4; k++) {
            const double coarse = bounce(law, k / 2 ? 0.3 : 0, k % 2, 0.04);
            const double fine = bounce(law, k / 2 ? 0.3 : 0, k % 2, 0.01);
            assert_true(fine < 5e-4);
            assert_true(fine < 0.5 * coarse);
        }
}
