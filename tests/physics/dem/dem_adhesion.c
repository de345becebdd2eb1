// SPDX-License-Identifier: GPL-3.0-or-later
// Adhesion of dry grains: the closed forms of Johnson, Kendall & Roberts (1971), and
// the speed below which two grains stick (Thornton & Ning 1998, Powder Technology 99,
// 154).
#include "../dem_scene.h"

#define GRAIN 1e-3 // m
#define WORK 0.2   // J/m2
#define MODULUS 1e7
#define POISSON 0.3

static struct dem_setup sticky(const struct packing *packing)
{
    return (struct dem_setup){.packing = packing,
                              .law = DEM_HERTZ,
                              .material = {.density = 2500,
                                           .young_modulus = MODULUS,
                                           .poisson_ratio = POISSON,
                                           .restitution = 1},
                              .adhesion = WORK,
                              .time_step_safety = 0.01,
                              .threads = 1};
}

static double mass_of(double radius)
{
    return 2500 * (4.0 / 3 * M_PI) * radius * radius * radius;
}

// Two grains that touch along x; or one on the plane x = 0.
static struct packing two_grains(int n, double first, double second)
{
    struct packing packing = new_packing(n, 0);
    packing.position[0] = (struct vector){first, 0, 0};
    packing.radius[0] = first;
    if (n > 1) {
        packing.position[1] = (struct vector){2 * first + second, 0, 0};
        packing.radius[1] = second;
    }
    packing.lower = (struct vector){-1, -1, -1};
    packing.upper = (struct vector){1, 1, 1};
    return packing;
}

// R* and E* of a contact.
struct jkr {
    double radius, modulus;
};

static double overlap_at(const struct jkr *is, double a)
{
    return a * a / is->radius - sqrt(2 * M_PI * WORK * a / is->modulus);
}

// The force that presses the grains together, by bisection of the overlap.
static double force_at(const struct jkr *is, double overlap)
{
    double low = cbrt(M_PI * WORK * is->radius * is->radius / (8 * is->modulus));
    double high = is->radius;
    if (overlap < overlap_at(is, low)) return 0;
    for (int k = 0; k < 200; k++) {
        const double a = 0.5 * (low + high);
        if (overlap_at(is, a) < overlap)
            low = a;
        else
            high = a;
    }
    return 4 * is->modulus * low * low * low / (3 * is->radius) -
           sqrt(8 * M_PI * WORK * is->modulus * low * low * low);
}

static double lone_contact(const struct dem *dem, double *overlap)
{
    int count;
    struct dem_contact *contact = dem_contacts(dem, &count);
    const double force = count > 0 ? contact->force.x : NAN;
    if (count > 0) *overlap = contact->overlap;
    free(contact);
    return force;
}

// Pressed into each other and drawn apart, at a speed that no force changes. Returns
// the largest pull.
static double press_and_draw(struct dem_setup setup, const struct jkr *is, int moves,
                             double sign)
{
    struct dem *dem = create(&setup);
    const double step = 2e-5 * GRAIN, speed = sign * step / dem_time_step(dem);
    double most = 0, overlap = 0, last = 0;
    for (int cycle = 0; cycle < 1000; cycle++) {
        struct vector velocity[2] = {{0, 0, 0}, {0, 0, 0}};
        velocity[moves].x = cycle < 200 ? -speed : speed;
        dem_set_velocity(dem, velocity, NULL);
        run(dem, 1);
        const double force = -sign * (moves ? -1 : 1) * lone_contact(dem, &overlap);
        if (isnan(force)) continue;
        assert_close(force, force_at(is, overlap), 1e-8);
        most = fmax(most, -force);
        last = overlap;
    }
    const double a = cbrt(M_PI * WORK * is->radius * is->radius / (8 * is->modulus));
    const double breaks = overlap_at(is, a);
    assert_true(last >= breaks && last < breaks + 1.1 * step);
    dem_free(dem);
    return most;
}

TEST(follows_the_closed_form)
{
    const double of_one = MODULUS / (1 - POISSON * POISSON);
    for (int unequal = 0; unequal < 2; unequal++) {
        const double other = unequal ? 3 * GRAIN : GRAIN;
        struct packing packing = two_grains(2, GRAIN, other);
        const struct jkr is = {GRAIN * other / (GRAIN + other), 0.5 * of_one};
        const double most = press_and_draw(sticky(&packing), &is, 1, 1);
        assert_close(most, 1.5 * M_PI * WORK * is.radius, 1e-4);
        packing_free(&packing);
    }
    struct packing packing = two_grains(1, GRAIN, 0);
    struct dem_setup setup = sticky(&packing);
    const struct dem_wall plane = {.normal = {1, 0, 0}};
    setup.wall = &plane;
    setup.n_wall = 1;
    const double most = press_and_draw(setup, &(struct jkr){GRAIN, of_one}, 0, 1);
    assert_close(most, 1.5 * M_PI * WORK * GRAIN, 1e-4);
    packing_free(&packing);
}

// A grain at rest on a plane without weight: the radius of the contact follows from its
// overlap, a^2 / (3 R). Under a pull it holds up to 3/2 pi w R.
TEST(holds_up_to_the_pull_off_force)
{
    const double modulus = MODULUS / (1 - POISSON * POISSON);
    struct packing packing = two_grains(1, GRAIN, 0);
    struct dem_setup setup = sticky(&packing);
    const struct dem_wall plane = {.normal = {1, 0, 0}};
    setup.wall = &plane;
    setup.n_wall = 1;
    setup.material.local_damping = 0.3;
    struct dem *dem = create(&setup);
    double overlap = 0;
    run(dem, 20000);
    assert_true(fabs(lone_contact(dem, &overlap)) < 1e-9 * WORK * GRAIN);
    const double a = cbrt(9 * M_PI * WORK * GRAIN * GRAIN / (2 * modulus));
    assert_close(overlap, a * a / (3 * GRAIN), 1e-9);
    const double pull = 1.5 * M_PI * WORK * GRAIN;
    int count;
    for (int k = 1; k <= 200; k++) { // ever more slowly
        const double share = 1 - pow(1 - k / 200.0, 2);
        dem_set_force(dem, &(struct vector){0.9999 * pull * share, 0, 0});
        run(dem, 5000);
    }
    free(dem_contacts(dem, &count));
    assert_int_equal(count, 1);
    dem_set_force(dem, &(struct vector){1.0001 * pull, 0, 0});
    run(dem, 200000);
    free(dem_contacts(dem, &count));
    assert_int_equal(count, 0);
    dem_free(dem);
    packing_free(&packing);
}

// Without dashpots a contact takes 7.09 (w^5 R^4 / E^2)^(1/3): what it gave when it
// formed less what it takes until it breaks.
TEST(energy_of_an_impact)
{
    const double radius = 0.5 * GRAIN;
    const double modulus = 0.5 * MODULUS / (1 - POISSON * POISSON);
    const double taken =
        7.09 * cbrt(pow(WORK, 5) * pow(radius, 4) / (modulus * modulus));
    struct packing packing = two_grains(2, GRAIN, GRAIN);
    packing.position[1].x += 1e-3 * GRAIN;
    const double mass = 0.5 * mass_of(GRAIN); // reduced
    struct dem_setup setup = sticky(&packing);
    setup.balance_energy = true;
    setup.time_step_safety = 2e-4; // it forms and breaks at the end of a step
    for (int fast = 0; fast < 2; fast++) {
        const double brought = (fast ? 1.5 : 0.95) * taken;
        const double speed = sqrt(2 * brought / mass);
        struct dem *dem = create(&setup);
        dem_set_velocity(
            dem, (struct vector[2]){{0.5 * speed, 0, 0}, {-0.5 * speed, 0, 0}}, NULL);
        const double began = dem_energy(dem).kinetic;
        run(dem, 1000000);
        int count;
        free(dem_contacts(dem, &count));
        const struct dem_energy now = dem_energy(dem);
        assert_int_equal(count, fast ? 0 : 1);
        if (fast) assert_close(began - now.kinetic, taken, 3e-3);
        assert_close(now.kinetic + now.elastic + now.bridges, began, 2e-3);
        dem_free(dem);
    }
    packing_free(&packing);
}

static void refuses(struct dem_setup setup)
{
    struct dem *dem;
    struct reason reason;
    assert_int_equal(dem_create(&dem, &setup, &reason), STATUS_BAD_DATA);
    assert_null(dem);
}

TEST(refuses_what_it_cannot)
{
    struct packing packing = two_grains(2, GRAIN, GRAIN);
    struct dem_setup setup = sticky(&packing);
    setup.adhesion = -1;
    refuses(setup);
    setup = sticky(&packing);
    setup.law = DEM_LINEAR;
    setup.material.normal_stiffness = setup.material.shear_stiffness = 100;
    refuses(setup);
    setup = sticky(&packing);
    const struct dem_liquid liquid = {
        .model = BRIDGE_WILLETT_FULL, .surface_tension = 0.07, .volume = 1e-12};
    setup.liquid = &liquid;
    refuses(setup);
    packing_free(&packing);
}
