// SPDX-License-Identifier: GPL-3.0-or-later
// Hard cases of the engine: stiffnesses a million apart, a grain that flies a thousand
// diameters a second into a packed bed, and time steps that are too long.
#include "../dem_scene.h"

static struct packing row_of_grains(int n, double radius, double gap)
{
    struct packing packing = new_packing(n, 0);
    for (int i = 0; i < n; i++) {
        packing.radius[i] = radius;
        packing.position[i] = (struct vector){i * (2 * radius + gap), 0, 0};
    }
    return packing;
}

// ---- contrast -----------------------------------------------------------------------

static const double contrast = 1e6;

// Soft and stiff, pressed together at the ends: every contact carries the force, and
// overlaps as the two springs in series say [K 4.22].
TEST(contrast_at_rest)
{
    enum { N = 6 };
    struct packing packing = row_of_grains(N, 1, 0);
    const uint8_t material_of[N] = {0, 0, 1, 1, 0, 1};
    const double soft = 1, stiff = contrast, force = 1e-6;
    const double pair_stiffness[N - 1] = {0.5 * soft, soft * stiff / (soft + stiff),
                                          0.5 * stiff, soft * stiff / (soft + stiff),
                                          soft * stiff / (soft + stiff)};
    const struct dem_material other = {
        .density = 1, .normal_stiffness = stiff, .damping_ratio = 0.5};
    const struct dem_setup setup = {
        .packing = &packing,
        .material = {.density = 1, .normal_stiffness = soft, .damping_ratio = 0.5},
        .n_other = 1,
        .other = &other,
        .material_of = material_of,
        .time_step_safety = 0.2,
        .threads = 1};
    struct dem *dem = create(&setup);
    struct vector pull[N] = {{force, 0, 0}};
    pull[N - 1].x = -force;
    dem_set_force(dem, pull);
    struct reason reason = {""};
    if (dem_run_until(dem, 1e-11, 20000000, &reason) != STATUS_OK)
        fail_msg("%s", reason.text);

    int count;
    struct dem_contact *contact = dem_contacts(dem, &count);
    assert_int_equal(count, N - 1);
    for (int k = 0; k < count; k++) {
        assert_close(contact[k].force.x, force, 1e-9);
        assert_close(contact[k].overlap, force / pair_stiffness[k], 1e-9);
    }
    free(contact);
    dem_free(dem);
    packing_free(&packing);
}

// Head on, without loss: two of one mass exchange their velocities whatever their
// stiffness, and what restitution says is left of a Hertz impact.
static void meet(enum dem_law law, double restitution)
{
    struct packing packing = row_of_grains(2, 1, 1e-9);
    const uint8_t material_of[2] = {0, 1};
    const struct dem_material soft = {.density = 1,
                                      .normal_stiffness = 1,
                                      .restitution = restitution,
                                      .young_modulus = 1,
                                      .poisson_ratio = 0.25};
    struct dem_material stiff = soft;
    stiff.normal_stiffness *= contrast;
    stiff.young_modulus *= contrast;
    const struct dem_setup setup = {.packing = &packing,
                                    .law = law,
                                    .material = soft,
                                    .n_other = 1,
                                    .other = &stiff,
                                    .material_of = material_of,
                                    .time_step_safety = 0.5,
                                    .threads = 1};
    struct dem *dem = create(&setup);
    const double speed = 1e-4;
    const struct vector before[2] = {{speed, 0, 0}, {0, 0, 0}};
    struct vector after[2] = {{0, 0, 0}};
    dem_set_velocity(dem, before, NULL);
    const double weight = 4.0 / 3 * M_PI, energy = 0.5 * weight * speed * speed;
    for (int k = 0; k < 4000 && after[1].x - after[0].x < 0.1 * speed; k++) {
        run(dem, 200);
        dem_velocities(dem, after);
        const struct dem_energy now = dem_energy(dem);
        assert_true(now.kinetic + now.elastic <= energy * (1 + 1e-6));
    }
    run(dem, 100000);
    dem_velocities(dem, after);
    assert_close(after[1].x, 0.5 * (1 + restitution) * speed, 1e-3);
    assert_close(after[0].x + after[1].x, speed, 1e-12);
    dem_free(dem);
    packing_free(&packing);
}

TEST(contrast_in_impact)
{
    meet(DEM_LINEAR, 1);
    meet(DEM_HERTZ, 1);
    meet(DEM_HERTZ, 0.5);
}

// ---- a fast grain -------------------------------------------------------------------

enum { SIDE = 6, BED = SIDE * SIDE * SIDE, SHOT = BED };
static const double shot_speed = 1e3 * 2 * RADIUS; // a thousand diameters a second

// A cubic bed on a floor within four walls, and a grain above it, off the axes of the
// lattice, that comes down at an angle.
static struct packing shot_scene(void)
{
    struct packing bed = cubic_lattice(SIDE, SIDE, SIDE, false);
    struct packing packing = new_packing(BED + 1, 0);
    memcpy(packing.position, bed.position, BED * sizeof *bed.position);
    packing.position[SHOT] = (struct vector){
        (SIDE + 0.3) * RADIUS, (SIDE - 0.4) * RADIUS, (2 * SIDE + 3) * RADIUS};
    packing.lower = bed.lower;
    packing.upper = bed.upper;
    packing.upper.z *= 2;
    packing_free(&bed);
    return packing;
}

static void shot_walls(const struct packing *packing, struct dem_wall wall[5])
{
    for (int w = 0; w < 5; w++) {
        wall[w] = (struct dem_wall){.point = w % 2 ? packing->upper : packing->lower};
        set_component(&wall[w].normal, w / 2, w % 2 ? -1 : 1);
    }
}

// The nearest that any two centres are, in sums of radii.
static double nearest(const struct vector *position)
{
    double least = INFINITY;
    for (int i = 0; i <= BED; i++)
        for (int j = 0; j < i; j++)
            least = fmin(least, distance(position[i], position[j]) / (2 * RADIUS));
    return least;
}

// No nearer than ROOM to the walls.
static bool is_within(const struct packing *packing, struct vector x, double room)
{
    return x.x > room && x.y > room && x.z > room && x.x < packing->upper.x - room &&
           x.y < packing->upper.y - room;
}

// So stiff that the first contact overlaps by SHARE of a radius: v = w U.
static struct dem_setup shot_setup(const struct packing *packing,
                                   const struct dem_wall *wall, double speed,
                                   double share)
{
    const double mass = 3230 * 4.0 / 3 * M_PI * RADIUS * RADIUS * RADIUS;
    const double frequency = speed / (share * RADIUS);
    const double pair_stiffness = 0.5 * mass * frequency * frequency;
    return (struct dem_setup){.packing = packing,
                              .material = {.density = 3230,
                                           .normal_stiffness = 2 * pair_stiffness,
                                           .shear_stiffness = pair_stiffness,
                                           .friction = 0.5,
                                           .damping_ratio = 0.1},
                              .n_wall = 5,
                              .wall = wall,
                              .time_step_safety = 0.1,
                              .balance_energy = true,
                              .threads = 1};
}

// Nothing goes through anything, all stay within the walls, energy only falls. Returns
// how far its books are off in the end, of all; what dashpots take is of first order in
// the step, as they see the velocity of half a step before.
static double shoot(double safety)
{
    struct packing packing = shot_scene();
    struct dem_wall wall[5];
    shot_walls(&packing, wall);
    struct dem_setup setup = shot_setup(&packing, wall, shot_speed, 0.2);
    setup.time_step_safety = safety;
    struct dem *dem = create(&setup);
    struct vector velocity[BED + 1] = {{0, 0, 0}}, now[BED + 1];
    velocity[SHOT] =
        (struct vector){0.3 * shot_speed, 0.1 * shot_speed, -0.95 * shot_speed};
    dem_set_velocity(dem, velocity, NULL);
    run(dem, 1);
    struct dem_energy energy = dem_energy(dem);
    const double all = energy.kinetic + energy.elastic;
    for (int k = 0; k < 400; k++) {
        const double before = energy.kinetic + energy.elastic;
        run(dem, (int64_t)(5 / safety));
        dem_positions(dem, now);
        assert_true(nearest(now) > 0.8);
        for (int i = 0; i <= BED; i++)
            assert_true(is_within(&packing, now[i], 0.6 * RADIUS));
        energy = dem_energy(dem);
        assert_true(energy.kinetic + energy.elastic < before + 1e-5 * all);
    }
    assert_true(energy.kinetic + energy.elastic < 0.1 * all); // it did hit
    dem_free(dem);
    packing_free(&packing);
    return (energy.kinetic + energy.elastic + energy.dashpots + energy.slip) / all - 1;
}

TEST(fast_grain)
{
    const double coarse = shoot(0.1), fine = shoot(0.05);
    if (!(fabs(coarse) < 0.02 && fabs(coarse / fine - 2) < 0.25))
        fail_msg("books off by %g and %g", coarse, fine);
}

// ---- too long a step ----------------------------------------------------------------

// Faster than a tenth of a radius in a step: stopped and said, whatever the contacts.
TEST(too_fast_for_the_step)
{
    struct packing packing = shot_scene();
    struct dem_wall wall[5];
    shot_walls(&packing, wall);
    struct dem_setup setup = shot_setup(&packing, wall, shot_speed, 0.2);
    setup.time_step = 1e-4; // a fifth of a radius
    setup.force_time_step = true;
    struct dem *dem = create(&setup);
    struct vector velocity[BED + 1] = {{0, 0, 0}}, now[BED + 1];
    velocity[SHOT].z = -shot_speed;
    dem_set_velocity(dem, velocity, NULL);
    struct reason reason = {""};
    assert_int_equal(dem_run(dem, 1000, &reason), STATUS_NOT_CONVERGED);
    assert_non_null(strstr(reason.text, "diverged in cycle 0"));
    dem_positions(dem, now);
    for (int i = 0; i <= BED; i++)
        assert_true(isfinite(norm(now[i])));
    dem_free(dem);
    packing_free(&packing);
}

// A grain of a twentieth, beside another, whose surface moves by SHARE of the mean
// radius in a step.
static enum status spin_small_grain(double share, struct reason *reason)
{
    struct packing packing = new_packing(2, 0);
    packing.radius[1] = RADIUS / 20;
    packing.position[1].x = 1.06 * RADIUS;
    const double mean = 0.5 * (packing.radius[0] + packing.radius[1]);
    const struct dem_setup setup = stiff_setup(&packing);
    struct dem *dem = create(&setup);
    const double angle = share * mean / packing.radius[1];
    const struct vector spin[] = {{0, 0, 0}, {0, 0, angle / dem_time_step(dem)}};
    dem_set_velocity(dem, NULL, spin);
    const enum status status = dem_run(dem, 10, reason);
    dem_free(dem);
    packing_free(&packing);
    return status;
}

// It is its own surface that counts, not how far one of the largest would turn; and a
// step that is stable is not called unstable.
TEST(small_grain_turns)
{
    struct reason reason = {""};
    assert_int_equal(spin_small_grain(0.0999, &reason), STATUS_OK);
    assert_int_equal(spin_small_grain(0.1001, &reason), STATUS_NOT_CONVERGED);
    assert_non_null(strstr(reason.text, "more than 0.1 mean radii"));
    assert_non_null(strstr(reason.text, "within the stability limit"));
}

// Two, ten and a thousand times the limit: refused with the limit named; forced, it
// runs on or says that it diverged, and no number is ever anything but finite.
TEST(past_the_limit)
{
    struct packing packing = shot_scene();
    struct dem_wall wall[5];
    shot_walls(&packing, wall);
    const double times[] = {2, 10, 1000};
    int diverged = 0;
    for (int k = 0; k < 3; k++) {
        struct dem_setup setup = shot_setup(&packing, wall, shot_speed, 0.2);
        struct dem *dem = create(&setup);
        setup.time_step = times[k] * dem_time_step_limit(dem);
        dem_free(dem);
        struct reason reason = {""};
        assert_int_equal(dem_create(&dem, &setup, &reason), STATUS_NOT_CONVERGED);
        char limit[64];
        snprintf(limit, sizeof limit, "limit of %g s", setup.time_step / times[k]);
        assert_non_null(strstr(reason.text, limit));

        setup.force_time_step = true;
        dem = create(&setup);
        struct vector *velocity = random_vectors(BED + 1, 0.01 * shot_speed, 3);
        struct vector now[BED + 1];
        dem_set_velocity(dem, velocity, velocity);
        const enum status status = dem_run(dem, 20000, &reason);
        diverged += times[k] >= 10 && status == STATUS_NOT_CONVERGED;
        assert_true(status == STATUS_OK || strstr(reason.text, "diverged"));
        dem_positions(dem, now);
        for (int i = 0; i <= BED; i++)
            assert_true(isfinite(norm(now[i])));
        const struct dem_energy energy = dem_energy(dem);
        assert_true(isfinite(energy.kinetic) && isfinite(energy.elastic));
        free(velocity);
        dem_free(dem);
    }
    assert_int_equal(diverged, 2); // far past it there is no other way
    packing_free(&packing);
}
