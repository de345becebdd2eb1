// SPDX-License-Identifier: GPL-3.0-or-later
// A cloud of loose grains of many sizes that run into each other, with friction and
// dashpots: turning or renumbering the scene makes no difference, whichever the law.
#include "../dem_scene.h"

enum { GRAINS = 30, STEPS = 200 };

struct scene {
    struct vector position[GRAINS], velocity[GRAINS], spin[GRAINS], force[GRAINS];
    double radius[GRAINS];
};

// On a cubic lattice that is shaken, pulled to the middle.
static struct scene some_scene(void)
{
    struct scene scene;
    uint64_t seed = 21;
    struct vector *jolt = random_vectors(3 * GRAINS, 1, 22);
    for (int i = 0; i < GRAINS; i++) {
        const struct vector at = {i % 3, i / 3 % 3, (double)(i / 9)};
        scene.radius[i] = RADIUS * (0.9 + 0.1 * next_signed(&seed));
        scene.position[i] = scale(1.85 * RADIUS, add(at, scale(0.03, jolt[i])));
        scene.velocity[i] = jolt[GRAINS + i];
        scene.force[i] = scale(-3e-8, subtract(at, (struct vector){1, 1, 1.5}));
        scene.spin[i] = scale(2 / RADIUS, jolt[2 * GRAINS + i]);
    }
    free(jolt);
    return scene;
}

static struct dem *start(const struct scene *scene, enum dem_law law)
{
    struct scene copy = *scene;
    const struct packing packing = {
        .n_particle = GRAINS, .position = copy.position, .radius = copy.radius};
    const struct dem_setup setup = {.packing = &packing,
                                    .law = law,
                                    .material = {.density = 2500,
                                                 .normal_stiffness = 30,
                                                 .shear_stiffness = 20,
                                                 .friction = 0.4,
                                                 .damping_ratio = 0.2,
                                                 .contact_time = 1e-8,
                                                 .restitution = 0.7,
                                                 .young_modulus = 1e8,
                                                 .poisson_ratio = 0.25},
                                    .largest_overlap = 0.2,
                                    .time_step_safety = 0.1,
                                    .threads = 1};
    struct dem *dem = create(&setup);
    dem_set_velocity(dem, scene->velocity, scene->spin);
    dem_set_force(dem, scene->force);
    run(dem, STEPS);
    return dem;
}

struct rotation {
    struct vector row[3];
};

static struct vector rotate(const struct rotation *r, struct vector a)
{
    return (struct vector){dot(r->row[0], a), dot(r->row[1], a), dot(r->row[2], a)};
}

// Largest difference of A[i], turned, from B[number[i]], over the largest of them.
static double difference(const struct rotation *turn, const int *number,
                         const struct vector *a, const struct vector *b)
{
    double worst = 0, largest = 0;
    for (int i = 0; i < GRAINS; i++) {
        worst = fmax(worst, distance(rotate(turn, a[i]), b[number[i]]));
        largest = fmax(largest, norm(a[i]));
    }
    return worst / largest;
}

// Displacements, velocities, spins; and the forces between grains, summed on each.
static void assert_same(const struct rotation *turn, const int *number,
                        const struct dem *a, const struct dem *b)
{
    const struct dem *const dem[2] = {a, b};
    struct vector moved[2][GRAINS], velocity[2][GRAINS], spin[2][GRAINS];
    struct vector force[2][GRAINS] = {{{0}}};
    int count[2];
    for (int k = 0; k < 2; k++) {
        dem_displacements(dem[k], moved[k]);
        dem_velocities(dem[k], velocity[k]);
        dem_spins(dem[k], spin[k]);
        struct dem_contact *contact = dem_contacts(dem[k], &count[k]);
        for (int c = 0; c < count[k]; c++) {
            struct vector *first = &force[k][contact[c].particle[0]];
            struct vector *second = &force[k][contact[c].particle[1]];
            *first = subtract(*first, contact[c].force);
            *second = add(*second, contact[c].force);
        }
        free(contact);
    }
    assert_int_equal(count[0], count[1]);

    assert_in_range(count[0], 20, 3 * GRAINS);
    const double off[4] = {difference(turn, number, moved[0], moved[1]),
                           difference(turn, number, velocity[0], velocity[1]),
                           difference(turn, number, spin[0], spin[1]),
                           difference(turn, number, force[0], force[1])};
    for (int i = 0; i < 4; i++)
        if (!(off[i] < 1e-12))
            fail_msg(
                "displacements, velocities, spins, forces differ by %g, %g, %g, %g",
                off[0], off[1], off[2], off[3]);
}

static const enum dem_law laws[3] = {DEM_LINEAR, DEM_TIMED, DEM_HERTZ};

TEST(rotation)
{
    const struct vector x = {2.0 / 7, 3.0 / 7, 6.0 / 7},
                        y = {6.0 / 7, 2.0 / 7, -3.0 / 7};
    const struct rotation turn = {{x, y, cross(x, y)}};
    int number[GRAINS];
    struct scene scene = some_scene(), turned = scene;
    for (int i = 0; i < GRAINS; i++) {
        number[i] = i;
        turned.position[i] = rotate(&turn, scene.position[i]);
        turned.velocity[i] = rotate(&turn, scene.velocity[i]);
        turned.force[i] = rotate(&turn, scene.force[i]);
        turned.spin[i] = rotate(&turn, scene.spin[i]);
    }
    for (int k = 0; k < 3; k++) {
        struct dem *dem[2] = {start(&scene, laws[k]), start(&turned, laws[k])};
        assert_same(&turn, number, dem[0], dem[1]);
        dem_free(dem[0]);
        dem_free(dem[1]);
    }
}

// Many pairs come to be the other way round.
TEST(numbering)
{
    const struct rotation none = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    int number[GRAINS];
    struct scene scene = some_scene(), renumbered;
    for (int i = 0; i < GRAINS; i++) {
        const int j = number[i] = (i * 17 + 5) % GRAINS; // 17 and 30 share no factor
        renumbered.position[j] = scene.position[i];
        renumbered.velocity[j] = scene.velocity[i];
        renumbered.force[j] = scene.force[i];
        renumbered.spin[j] = scene.spin[i];
        renumbered.radius[j] = scene.radius[i];
    }
    for (int k = 0; k < 3; k++) {
        struct dem *dem[2] = {start(&scene, laws[k]), start(&renumbered, laws[k])};
        assert_same(&none, number, dem[0], dem[1]);
        dem_free(dem[0]);
        dem_free(dem[1]);
    }
}
