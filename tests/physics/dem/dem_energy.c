// SPDX-License-Identifier: GPL-3.0-or-later
// The books of energy: what was put in is there, or is accounted for as lost, and the
// closer so the shorter the time step.
#include "../dem_scene.h"

enum { SIDE = 4, N = SIDE * SIDE * SIDE };

// Loose grains of different sizes, thrown about in a closed box.
static struct packing loose_grains(void)
{
    struct packing packing = new_packing(N, 0);
    uint64_t seed = 31;
    for (int i = 0; i < N; i++) {
        const int at[3] = {i % SIDE, i / SIDE % SIDE, i / (SIDE * SIDE)};
        packing.radius[i] = RADIUS * (1 + 0.1 * next_signed(&seed));
        packing.position[i] =
            (struct vector){(2.3 * at[0] + 1.2) * RADIUS, (2.3 * at[1] + 1.2) * RADIUS,
                            (2.3 * at[2] + 1.2) * RADIUS};
    }
    packing.upper =
        (struct vector){2.3 * SIDE * RADIUS, 2.3 * SIDE * RADIUS, 2.3 * SIDE * RADIUS};
    return packing;
}

static void box_of(const struct packing *packing, struct dem_wall wall[6])
{
    for (int w = 0; w < 6; w++) {
        wall[w] = (struct dem_wall){.point = w % 2 ? packing->upper : packing->lower};
        set_component(&wall[w].normal, w / 2, w % 2 ? -1 : 1);
    }
}

// What is missing after the run, over all that went through the books.
static double imbalance(struct dem *dem, double began)
{
    const struct dem_energy now = dem_energy(dem);
    const double lost = now.dashpots + now.slip + now.local_damping + now.broken;
    const double there = now.kinetic + now.elastic + lost;
    return fabs(there - began - now.gained) / (began + fabs(now.gained));
}

// After the same time with time steps of SAFETY.
static double shaken_box(struct dem_setup setup, double safety, struct dem_energy *end)
{
    struct packing packing = loose_grains();
    struct dem_wall wall[6];
    box_of(&packing, wall);
    setup.packing = &packing;
    setup.wall = wall;
    setup.n_wall = 6;
    setup.balance_energy = true;
    setup.time_step_safety = safety;
    struct dem *dem = create(&setup);
    struct vector *velocity = random_vectors(N, 0.5, 32);
    struct vector *spin = random_vectors(N, 0.5 / RADIUS, 33);
    dem_set_velocity(dem, velocity, spin);
    free(velocity);
    free(spin);
    const double began = dem_energy(dem).kinetic;
    run(dem, (int64_t)(40 / safety));
    const double missing = imbalance(dem, began);
    *end = dem_energy(dem);
    dem_free(dem);
    packing_free(&packing);
    return missing;
}

static void assert_books_close(struct dem_setup setup, double tolerance)
{
    struct dem_energy end;
    const double coarse = shaken_box(setup, 0.02, &end);
    const double fine = shaken_box(setup, 0.005, &end);
    if (!(fine < tolerance)) fail_msg("missing: %g of all", fine);
    if (!(fine < 0.5 * coarse))
        fail_msg("missing: %g, and %g in longer steps", fine, coarse);
    assert_true(end.slip > 0.01 * end.kinetic && end.dashpots > 0.01 * end.kinetic);
}

static struct dem_setup rubbing_setup(enum dem_law law)
{
    return (struct dem_setup){.law = law,
                              .material = {.density = 2500,
                                           .normal_stiffness = 100,
                                           .shear_stiffness = 100 * 2.0 / 7,
                                           .friction = 0.3,
                                           .damping_ratio = 0.1,
                                           .contact_time = 1e-7,
                                           .restitution = 0.8,
                                           .young_modulus = 1e9,
                                           .poisson_ratio = 0.2},
                              .gravity = {0, 0, -1e5},
                              .threads = 1};
}

TEST(books_of_each_law)
{
    assert_books_close(rubbing_setup(DEM_LINEAR), 2e-3);
    assert_books_close(rubbing_setup(DEM_TIMED), 2e-3);
    assert_books_close(rubbing_setup(DEM_HERTZ), 2e-3);
    struct dem_setup whole = rubbing_setup(DEM_HERTZ);
    whole.friction_feels_dashpot = true;
    assert_books_close(whole, 2e-3);
}

// Dashpots that do not pull take less. A bond's still do: bonded grains move as before.
TEST(books_without_tensile_damping)
{
    struct dem_setup setup = rubbing_setup(DEM_LINEAR);
    setup.no_tensile_damping = true;
    assert_books_close(setup, 2e-3);

    struct packing packing = bonded_pair();
    struct vector moved[2];
    for (int pulls = 0; pulls < 2; pulls++) {
        struct dem_setup bonded = stiff_setup(&packing);
        bonded.no_tensile_damping = !pulls;
        struct dem *dem = shaken(&bonded, 1e-3, 3);
        run(dem, 300);
        moved[pulls] = displacement_of(dem, 1);
        dem_free(dem);
    }
    assert_memory_equal(&moved[0], &moved[1], sizeof *moved);
    packing_free(&packing);
}

TEST(books_of_local_damping)
{
    struct dem_setup setup = rubbing_setup(DEM_LINEAR);
    setup.material.local_damping = 0.3;
    struct dem_energy end;
    const double missing = shaken_box(setup, 0.005, &end);
    if (!(missing < 2e-3)) fail_msg("missing: %g", missing);
    assert_true(end.local_damping > 0.02 * end.kinetic);
}

// Grains in a box that repeats and closes in: its work is in the books.
static double strained_box(struct dem_setup setup, double safety,
                           struct dem_energy *end)
{
    enum { STEPS = 200 };
    struct packing packing = loose_grains();
    packing.periodic[0] = packing.periodic[1] = packing.periodic[2] = true;
    setup.packing = &packing;
    setup.balance_energy = true;
    setup.time_step_safety = safety;
    setup.gravity.z = 0;
    struct dem *dem = create(&setup);
    struct vector *velocity = random_vectors(N, 0.2, 32);
    dem_set_velocity(dem, velocity, NULL);
    free(velocity);
    const double began = dem_energy(dem).kinetic;
    const double stretch[3] = {exp(-0.3 / STEPS), exp(-0.2 / STEPS),
                               exp(-0.25 / STEPS)};
    for (int k = 0; k < STEPS; k++) {
        assert_int_equal(dem_rescale(dem, stretch, 1), STATUS_OK);
        run(dem, (int64_t)(0.4 / safety));
    }
    const double missing = imbalance(dem, began);
    *end = dem_energy(dem);
    dem_free(dem);
    packing_free(&packing);
    return missing;
}

TEST(books_of_a_strained_box)
{
    for (int law = DEM_LINEAR; law <= DEM_HERTZ; law++) {
        struct dem_energy end;
        const struct dem_setup setup = rubbing_setup((enum dem_law)law);
        const double coarse = strained_box(setup, 0.02, &end);
        const double fine = strained_box(setup, 0.005, &end);
        if (!(fine < 2e-3 && fine < 0.5 * coarse))
            fail_msg("law %d missing: %g, and %g in longer steps", law, fine, coarse);
        assert_true(end.gained > end.kinetic && end.elastic > 0.1 * end.gained);
    }
}

// Springs and dashpots against rolling, between grains and at walls.
TEST(books_of_rolling)
{
    for (int law = DEM_LINEAR; law <= DEM_HERTZ; law++) {
        struct dem_setup setup = rubbing_setup((enum dem_law)law);
        setup.material.rolling_friction = 0.2;
        assert_books_close(setup, 2e-3);
        setup.material.rolling_damping = 0.5;
        setup.friction_feels_dashpot = true;
        assert_books_close(setup, 2e-3);
        struct dem_energy rolling, sliding;
        shaken_box(setup, 0.005, &rolling);
        setup.material.rolling_friction = 0;
        shaken_box(setup, 0.005, &sliding);
        assert_true(fabs(rolling.slip - sliding.slip) > 0.01 * sliding.slip);
    }
}

// A lattice torn apart by forces on its two ends: what the bonds held when they broke
// is in the books.
static double torn_apart(enum dem_bond_kind kind, double safety)
{
    struct packing packing = cubic_lattice(3, 3, 4, false);
    struct dem_setup setup = stiff_setup(&packing);
    setup.material.damping_ratio = 0.2;
    setup.balance_energy = true;
    setup.time_step_safety = safety;
    setup.bond.kind = kind;
    setup.bond.normal_strength = kind == DEM_CONTACT_BOND ? 1e-7 : 2e6;
    setup.bond.shear_strength = setup.bond.normal_strength;
    struct dem *dem = create(&setup);
    struct vector force[36] = {{0, 0, 0}};
    for (int i = 0; i < 36; i++)
        if (i < 9 || i >= 27)
            force[i] = (struct vector){(i % 3 - 1) * 1e-8, 0, i < 9 ? -2e-7 : 2e-7};
    dem_set_force(dem, force);
    int cracks = 0;
    for (int k = 0; k < 1000 && cracks < 9; k++) {
        run(dem, 100);
        dem_cracks(dem, &cracks);
    }
    assert_true(cracks >= 9);
    const struct dem_energy end = dem_energy(dem);
    assert_true(end.broken > 0.1 * end.gained);
    const double missing = imbalance(dem, 0);
    dem_free(dem);
    packing_free(&packing);
    return missing;
}

TEST(books_of_broken_bonds)
{
    for (int kind = 0; kind < 2; kind++) {
        const double coarse = torn_apart(kind, 0.004), fine = torn_apart(kind, 0.001);
        if (!(fine < 1e-3 && fine < 0.5 * coarse))
            fail_msg("kind %d missing: %g, and %g in longer steps", kind, fine, coarse);
    }
}
