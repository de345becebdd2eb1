// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of grains that move as rigid bodies, against closed forms, Newton's third law
// and the balance of energy.
#include "wall_scene.h"

// AXIS x X by ANGLE, by the matrix of a rotation.
static struct vector rotated(struct vector axis, double angle, struct vector x)
{
    const struct vector a = scale(1 / norm(axis), axis);
    const double c = cos(angle), s = sin(angle);
    const struct vector row[3] = {
        {c + a.x * a.x * (1 - c), a.x * a.y * (1 - c) - a.z * s,
         a.x * a.z * (1 - c) + a.y * s},
        {a.y * a.x * (1 - c) + a.z * s, c + a.y * a.y * (1 - c),
         a.y * a.z * (1 - c) - a.x * s},
        {a.z * a.x * (1 - c) - a.y * s, a.z * a.y * (1 - c) + a.x * s,
         c + a.z * a.z * (1 - c)}};
    return (struct vector){dot(row[0], x), dot(row[1], x), dot(row[2], x)};
}

// Two bodies about an oblique axis, one of which is told to turn back on the way: no
// drift after twenty turns and a hundred thousand steps.
TEST(places_in_closed_form)
{
    enum { N = 40 };
    struct vector *position = random_vectors(N, 5 * GRAIN, 3);
    uint8_t of[N];
    for (int i = 0; i < N; i++)
        of[i] = (uint8_t)(1 + i % 2);
    struct dem_group group[2] = {
        {{1e-3, 2e-3, -1e-3}, {1, -2, 3}, {1e-3, -2e-3, 5e-4}, 0},
        {{0, 0, 0}, {0, 0.1, 0.1}, {0, 0, 0}, 0}};
    struct scene scene;
    set_scene(&scene, N, position, 0, NULL);
    scene.setup.material.friction = 0.3;
    scene.setup.n_group = 2;
    scene.setup.group = group;
    scene.setup.group_of = of;
    struct dem *dem = create(&scene.setup);
    const double dt = dem_time_step(dem), spin = 1e-3 / dt;
    dem_set_group_motion(dem, 0, group[0].velocity, spin);
    dem_set_group_motion(dem, 1, (struct vector){0, 0, 0}, spin);
    run(dem, 60000);
    const struct vector back = {0, 2e-3, 0};
    dem_set_group_motion(dem, 0, back, 2 * spin);
    dem_set_group_motion(dem, 1, back, -spin);
    run(dem, 40000);

    const double time[2] = {6e4 * dt, 4e4 * dt};
    const double angle[2] = {6e4 * 1e-3 + 4e4 * 2e-3, 6e4 * 1e-3 - 4e4 * 1e-3};
    struct vector moved[2], *x = NEW_ARRAY(struct vector, N);
    moved[0] = add(scale(time[0], group[0].velocity), scale(time[1], back));
    moved[1] = scale(time[1], back);
    dem_positions(dem, x);
    for (int i = 0; i < N; i++) {
        const struct dem_group *g = &group[i % 2];
        const struct vector lever = subtract(position[i], g->point);
        const struct vector wanted =
            add(add(g->point, moved[i % 2]), rotated(g->axis, angle[i % 2], lever));
        assert_near(x[i], wanted, 1e-14 * norm(lever) + 1e-14 * norm(moved[i % 2]));
    }
    for (int g = 0; g < 2; g++) {
        assert_close(dem_group_state(dem, g).angle, angle[g], 1e-13);
        assert_near(dem_group_state(dem, g).displacement, moved[g],
                    1e-13 * norm(moved[g]));
    }
    // Velocities belong to the middle of the last step.
    const struct vector half = rotated(group[1].axis, angle[1] + 0.5e-3,
                                       subtract(position[1], group[1].point));
    const struct vector axis = scale(1 / norm(group[1].axis), group[1].axis);
    const struct vector v = add(back, scale(-spin, cross(axis, half)));
    assert_near(of_grain(dem, 1, dem_velocities), v, 1e-6 * norm(v)); // spin dt squared
    assert_near(of_grain(dem, 1, dem_spins), scale(-spin, axis), 1e-12 * spin);
    dem_free(dem);
    packing_free(&scene.packing);
    free(position);
    free(x);
}

// A sun that turns, a planet that rolls between it and a ring at rest: with radii a and
// R the planet's centre goes at half the speed of the sun's surface.
TEST(planet_rolls)
{
    const double a = 3 * GRAIN, squeeze = 1e-5 * GRAIN, rate = 5;
    const struct vector position[2] = {{0, 0, 0}, {a + GRAIN - squeeze, 0, 0}};
    const struct dem_wall ring = {.shape = DEM_SPHERE,
                                  .radius = a + 2 * GRAIN - 2 * squeeze};
    const struct dem_group sun = {.axis = {0, 0, 2}, .spin = rate};
    const uint8_t of[2] = {1, 0};
    struct scene scene;
    set_scene(&scene, 2, position, 1, &ring);
    scene.packing.radius[0] = a;
    scene.setup.material.friction = 0.5;
    scene.setup.material.damping_ratio = 0.3;
    scene.setup.n_group = 1;
    scene.setup.group = &sun;
    scene.setup.group_of = of;
    struct dem *dem = create(&scene.setup);
    const double speed = 0.5 * rate * a, orbit = speed / (a + GRAIN);
    const struct vector velocity[2] = {{0, 0, 0}, {0, speed, 0}};
    const struct vector spin[2] = {{0, 0, 0}, {0, 0, -speed / GRAIN}};
    dem_set_velocity(dem, velocity, spin);
    run(dem, (int64_t)rint(M_PI / orbit / dem_time_step(dem))); // half a round
    const struct vector moved = of_grain(dem, 1, dem_displacements);
    assert_near(moved, (struct vector){-2 * (a + GRAIN), 0, 0}, 1e-4 * GRAIN);
    assert_close(of_grain(dem, 1, dem_spins).z, -speed / GRAIN, 1e-3);
    assert_close(dem_group_state(dem, 0).angle, rate * M_PI / orbit, 1e-3);
    dem_free(dem);
    packing_free(&scene.packing);
}

// A driven grain bats a free one at speed V: that leaves at 2 V with the work 2 m V^2.
// On the way through the contact the balance holds to the second order of the step.
static double bat(double safety, double part, bool turning)
{
    const struct vector position[2] = {{0, 0, 0}, {2 * GRAIN, 0, 0}};
    const double speed = 0.05, arm = 10 * GRAIN;
    const uint8_t of[2] = {1, 0};
    struct dem_group group = {.velocity = {speed, 0, 0}};
    if (turning)
        group = (struct dem_group){
            .point = {0, -arm, 0}, .axis = {0, 0, -1}, .spin = speed / arm};
    struct scene scene;
    set_scene(&scene, 2, position, 0, NULL);
    scene.setup.n_group = 1;
    scene.setup.group = &group;
    scene.setup.group_of = of;
    scene.setup.time_step_safety = safety;
    struct dem *dem = create(&scene.setup);
    const double period = M_PI * sqrt(mass() / (0.5 * stiffness)); // of the contact
    run(dem, (int64_t)rint(part * period / dem_time_step(dem)));
    const struct dem_energy now = dem_energy(dem);
    const double whole = 2 * mass() * speed * speed;
    if (part > 1) {
        assert_close(of_grain(dem, 1, dem_velocities).x, 2 * speed, 1e-3);
        assert_close(now.gained, whole, 2e-5);
    }
    dem_free(dem);
    packing_free(&scene.packing);
    return fabs(now.kinetic + now.elastic - now.gained) / whole;
}

TEST(work_of_a_bat)
{
    for (int turning = 0; turning < 2; turning++) {
        bat(0.01, 1.2, turning);
        for (int k = 0; k < 3; k++) {
            const double part = 0.3 + 0.2 * k;
            const double coarse = bat(0.04, part, turning),
                         fine = bat(0.02, part, turning);
            if (!(coarse < 1e-3 && fine < 0.27 * coarse + 1e-12))
                fail_msg("missing %g, in longer steps %g", fine, coarse);
        }
    }
}

// ---- a mixer ------------------------------------------------------------------------

enum { EDGE = 7, LOOSE = EDGE * EDGE * EDGE, BLADE = 12, ALL = LOOSE + 2 * BLADE };

// Loose grains in a box, and two blades of overlapping grains among them.
struct mixer {
    struct scene scene;
    struct dem_wall wall[6];
    struct dem_group group[2];
    uint8_t of[ALL];
};

static void set_mixer(struct mixer *mixer, bool closed)
{
    const double side = 2.4 * GRAIN * EDGE, middle = 0.5 * side;
    struct vector *position = NEW_ARRAY(struct vector, ALL);
    for (int i = 0; i < LOOSE; i++)
        position[i] =
            scale(2.4 * GRAIN, (struct vector){i % EDGE + 0.5, i / EDGE % EDGE + 0.5,
                                               i / (EDGE * EDGE) + 0.5});
    for (int k = 0; k < 2 * BLADE; k++) { // between the layers
        const double at = 1.1 * (k / 2 - 0.5 * BLADE) * GRAIN;
        const double z = (k % 2 ? 4.8 : 9.6) * GRAIN;
        position[LOOSE + k] = (struct vector){middle + at, middle + 1.2 * GRAIN, z};
        mixer->of[LOOSE + k] = (uint8_t)(1 + k % 2);
    }
    memset(mixer->of, 0, LOOSE);
    for (int w = 0; w < 6; w++) {
        mixer->wall[w] = (struct dem_wall){0};
        if (w % 2) mixer->wall[w].point = (struct vector){side, side, side};
        set_component(&mixer->wall[w].normal, w / 2, w % 2 ? -1 : 1);
    }
    mixer->group[0] =
        (struct dem_group){.point = {middle, middle, 0}, .axis = {0, 0, 1}, .spin = 30};
    mixer->group[1] = (struct dem_group){.point = {middle, middle, 1e-3},
                                         .axis = {0, 0.1, -1},
                                         .spin = 40,
                                         .velocity = {0.02, 0, 0}};
    set_scene(&mixer->scene, ALL, position, closed ? 6 : 0, mixer->wall);
    for (int i = 0; i < LOOSE; i++)
        mixer->scene.packing.radius[i] *= i % 3 ? 1 : 0.9;
    for (int i = LOOSE; i < ALL; i++)
        mixer->scene.packing.radius[i] *= 0.7;
    struct dem_setup *setup = &mixer->scene.setup;
    setup->material.normal_stiffness = 50;
    setup->material.shear_stiffness = 40;
    setup->material.friction = 0.4;
    setup->material.damping_ratio = 0.2;
    setup->n_group = 2;
    setup->group = mixer->group;
    setup->group_of = mixer->of;
    setup->gravity = (struct vector){0, 0, -gravity};
    free(position);
}

// How far down grain I was at the last forces.
static double of_grain_then(const struct dem *dem, int i)
{
    return dem_time_step(dem) * of_grain(dem, i, dem_velocities).z -
           of_grain(dem, i, dem_displacements).z;
}

static double books_of_mixer(double safety, struct dem_energy *end)
{
    struct mixer mixer;
    set_mixer(&mixer, true);
    mixer.scene.setup.time_step_safety = safety;
    mixer.wall[5].velocity.z = -0.01; // a lid that comes down
    struct dem *dem = create(&mixer.scene.setup);
    const struct dem_energy began = dem_energy(dem);
    run(dem, (int64_t)rint(0.1 / dem_time_step(dem)));
    *end = dem_energy(dem);
    const double there = end->kinetic + end->elastic + end->dashpots + end->slip;
    const double work = end->gained;
    double drives = 0, moved = 0;
    for (int g = 0; g < 2; g++)
        drives += dem_group_state(dem, g).work;
    for (int w = 0; w < 6; w++)
        drives += dem_wall_state(dem, w).work;
    for (int i = 0; i < LOOSE; i++)
        moved += weight() * pow(mixer.scene.packing.radius[i] / GRAIN, 3) *
                 of_grain_then(dem, i);
    assert_close(drives + moved, work, 1e-9); // gravity does the rest
    dem_free(dem);
    packing_free(&mixer.scene.packing);
    return fabs(there - began.kinetic - began.elastic - work) / work;
}

TEST(books_of_a_mixer)
{
    struct dem_energy end;
    const double coarse = books_of_mixer(0.04, &end), fine = books_of_mixer(0.01, &end);
    if (!(fine < 3e-3 && fine < 0.4 * coarse)) // dashpots are of first order
        fail_msg("missing %g, in longer steps %g", fine, coarse);
    assert_true(end.slip > 0.05 * end.gained && end.dashpots > 0.05 * end.gained);
}

// Where groups were at the last forces, a step ago.
static struct vector point_of(const struct mixer *mixer, const struct dem *dem, int g)
{
    const struct dem_group *group = &mixer->group[g];
    return add(add(group->point, dem_group_state(dem, g).displacement),
               scale(-dem_time_step(dem), group->velocity));
}

// Force and moment on each group from the list of contacts; returns how large the
// forces are in sum.
static double from_contacts(const struct mixer *mixer, const struct dem *dem,
                            struct vector force[2], struct vector moment[2])
{
    int count;
    double size = 0;
    struct dem_contact *contact = dem_contacts(dem, &count);
    for (int k = 0; k < 2 * count; k++) {
        const struct dem_contact *c = &contact[k / 2];
        const int32_t grain = c->particle[k % 2], other = c->particle[1 - k % 2];
        const int g = grain < 0 ? -1 : mixer->of[grain] - 1;
        if (g < 0) continue;
        assert_true(other < 0 || mixer->of[other] != g + 1);
        const struct vector f = scale(k % 2 ? 1 : -1, c->force);
        const struct vector lever = subtract(c->position, point_of(mixer, dem, g));
        force[g] = add(force[g], f);
        moment[g] = add(moment[g], cross(lever, f));
        size += norm(f);
    }
    free(contact);
    return size;
}

// What all that moves feels: nothing, in sum, nor does it turn about the origin.
static void assert_is_balanced(const struct mixer *mixer, const struct dem *dem,
                               double size)
{
    struct vector sum = {0, 0, 0}, turning = {0, 0, 0};
    for (int g = 0; g < 2; g++) {
        const struct dem_group_state now = dem_group_state(dem, g);
        sum = add(sum, now.force);
        turning =
            add(turning, add(now.moment, cross(point_of(mixer, dem, g), now.force)));
    }
    for (int w = 0; w < 6; w++) {
        const struct dem_wall_state now = dem_wall_state(dem, w);
        sum = add(sum, now.force);
        turning = add(turning, add(now.moment, cross(mixer->wall[w].point, now.force)));
    }
    struct vector x[ALL], v[ALL], f[ALL], m[ALL];
    dem_positions(dem, x);
    dem_velocities(dem, v);
    dem_loads(dem, f, m);
    for (int i = 0; i < LOOSE; i++) {
        const struct vector then = add(x[i], scale(-dem_time_step(dem), v[i]));
        sum = add(sum, f[i]);
        turning = add(turning, add(m[i], cross(then, f[i])));
    }
    assert_near(sum, (struct vector){0, 0, 0}, 1e-13 * size);
    assert_near(turning, (struct vector){0, 0, 0}, 1e-12 * size * GRAIN * EDGE);
}

// Newton's third law, at thirty moments.
TEST(force_and_moment)
{
    struct mixer mixer;
    set_mixer(&mixer, true);
    mixer.scene.setup.gravity = (struct vector){0, 0, 0};
    struct dem *dem = create(&mixer.scene.setup);
    int seen = 0;
    for (int k = 0; k < 30; k++) {
        run(dem, (int64_t)rint(0.004 / dem_time_step(dem)));
        struct vector force[2] = {{0}}, moment[2] = {{0}};
        const double size = from_contacts(&mixer, dem, force, moment);
        for (int g = 0; g < 2; g++) {
            const struct dem_group_state now = dem_group_state(dem, g);
            assert_near(now.force, force[g], 1e-13 * size);
            assert_near(now.moment, moment[g], 1e-12 * size * GRAIN * EDGE);
            seen += norm(now.moment) > 0.1 * size * GRAIN;
        }
        double walls = 0;
        for (int w = 0; w < 6; w++)
            walls += norm(dem_wall_state(dem, w).force);
        assert_is_balanced(&mixer, dem, size + walls);
    }
    assert_true(seen > 10);
    dem_free(dem);
    packing_free(&mixer.scene.packing);
}

// ---- members ------------------------------------------------------------------------

// Overlapping grains of one group do not push each other, and weigh nothing.
TEST(members_are_glued)
{
    const struct vector position[3] = {{0, 0, 0}, {GRAIN, 0, 0}, {0, 0, 3 * GRAIN}};
    const struct dem_group group = {.velocity = {0, 0, 0}};
    const uint8_t of[3] = {1, 1, 0};
    struct scene scene;
    set_scene(&scene, 3, position, 0, NULL);
    scene.setup.n_group = 1;
    scene.setup.group = &group;
    scene.setup.group_of = of;
    scene.setup.gravity.z = -gravity;
    struct dem *dem = create(&scene.setup);
    run(dem, 10);
    int count;
    free(dem_contacts(dem, &count));
    assert_int_equal(count, 0);
    assert_near(dem_group_state(dem, 0).force, (struct vector){0, 0, 0}, 0);
    assert_true(of_grain(dem, 2, dem_displacements).z < 0);
    assert_true(norm(of_grain(dem, 1, dem_displacements)) == 0);
    const double stretch[3] = {1, 1, 1};
    assert_int_equal(dem_rescale(dem, stretch, 1.01), STATUS_BAD_DATA);
    dem_free(dem);
    packing_free(&scene.packing);
}

// A fixed grain and a group that slides past it, beside bonded grains far away, which
// let the engine leave out pairs that do nothing: this one has a shear spring.
TEST(drags_on_a_fixed_grain)
{
    enum { N = 10 };
    const double squeeze = 1e-3 * GRAIN, way = 1e-5 * GRAIN;
    struct vector position[N] = {{0, 0, 0}, {2 * GRAIN - squeeze, 0, 0}};
    uint8_t fixed[N] = {1}, of[N] = {0, 1};
    for (int i = 2; i < N; i++)
        position[i] = (struct vector){2 * GRAIN * i, 10 * GRAIN, 0};
    const struct dem_group group = {.velocity = {0, 0, 0}};
    struct scene scene;
    set_scene(&scene, N, position, 0, NULL);
    scene.packing.n_bond = N - 3;
    scene.packing.bond = reallocate(scene.packing.bond, N, sizeof *scene.packing.bond);
    for (int b = 0; b < N - 3; b++) {
        scene.packing.bond[b][0] = b + 2;
        scene.packing.bond[b][1] = b + 3;
    }
    scene.setup.bond = (struct dem_bond_material){1e8, 1e8, INFINITY,         INFINITY,
                                                  0.5, 0,   DEM_PARALLEL_BOND};
    scene.setup.balance_energy = false;
    scene.setup.material.friction = 0.5;
    scene.setup.n_group = 1;
    scene.setup.group = &group;
    scene.setup.group_of = of;
    scene.setup.fixed = fixed;
    struct dem *dem = create(&scene.setup);
    run(dem, 100);
    dem_set_group_motion(dem, 0, (struct vector){0, 0, way / 200 / dem_time_step(dem)},
                         0);
    run(dem, 201); // the last displacement pushes only then
    const struct vector wanted = {0.5 * stiffness * squeeze, 0,
                                  -0.5 * 0.8 * stiffness * way};
    assert_near(dem_group_state(dem, 0).force, wanted, 2e-3 * fabs(wanted.z));
    dem_free(dem);
    packing_free(&scene.packing);
}

TEST(refuses_what_it_cannot)
{
    const struct vector position[2] = {{0, 0, 0}, {2 * GRAIN, 0, 0}};
    struct dem_group group = {.velocity = {0, 0, 0}};
    const uint8_t of[2] = {1, 0}, beyond[2] = {0, 2}, fixed[2] = {1, 0};
    struct scene scene;
    set_scene(&scene, 2, position, 0, NULL);
    scene.setup.group = &group;
    scene.setup.group_of = of;
    assert_refused(scene.setup, "grain 0: no driven group 0 among 0");
    scene.setup.n_group = 256;
    assert_refused(scene.setup, "must be in [0,255]");
    scene.setup.n_group = 1;
    scene.setup.group_of = beyond;
    assert_refused(scene.setup, "grain 1: no driven group 1 among 1");
    scene.setup.group_of = of;
    scene.setup.fixed = fixed;
    assert_refused(scene.setup, "grain 0: is fixed and in driven group 0");
    scene.setup.fixed = NULL;
    group.spin = 1;
    assert_refused(scene.setup, "needs an axis");
    group.axis.x = NAN;
    assert_refused(scene.setup, "is not finite");

    group = (struct dem_group){.velocity = {1e3, 0, 0}}; // as fast as a free grain
    struct dem *dem = create(&scene.setup);
    struct reason reason = {""};
    assert_int_equal(dem_run(dem, 1, &reason), STATUS_NOT_CONVERGED);
    assert_non_null(strstr(reason.text, "diverged"));
    dem_free(dem);
    packing_free(&scene.packing);
}
