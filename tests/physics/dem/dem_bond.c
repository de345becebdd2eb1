// SPDX-License-Identifier: GPL-3.0-or-later
// Two grains and one bond: tension, shear, bending and twist give the closed-form
// stiffness and break at the closed-form load, in the right mode.
//
// With A = pi R^2, I = pi R^4/4, J = 2 I of the bond and the grains' radius r:
// tension moves the free grain by F/(k^n A); a force across the end of a pair, one
// grain held, by F/(k^s A) + F r^2/(k^n I), shear and bending of the bond; grains
// turning against each other make pure bending, one turning about the axis pure twist,
// both undamped, harmonic and known.
#include "../dem_scene.h"

// A soft contact, so that no step is lost on a stiffness that the test does not use.
static struct dem_setup soft_setup(const struct packing *packing)
{
    struct dem_setup setup = stiff_setup(packing);
    setup.material.normal_stiffness = setup.material.shear_stiffness = 20;
    setup.material.damping_ratio = 0.5;
    setup.bond.shear_stiffness = 5e14; // unlike the normal one
    return setup;
}

static const uint8_t first_fixed[2] = {1, 0};

static double bond_radius(void)
{
    return 0.5858 * RADIUS;
}

static double bond_area(void)
{
    return M_PI * bond_radius() * bond_radius();
}

static double bending_inertia(void)
{
    return M_PI / 4 * pow(bond_radius(), 4);
}

static double grain_inertia(void)
{
    return 0.4 * 3230 * 4.0 / 3 * M_PI * pow(RADIUS, 5);
}

// Raises a force on the second grain, slowly and with time to settle, from 0 to LOAD.
static void raise_force(struct dem *dem, struct vector load, int steps)
{
    for (int k = 1; k <= steps; k++) {
        push(dem, 1, scale((double)k / steps, load));
        run(dem, 2000);
    }
}

TEST(tension_stiffness)
{
    struct packing packing = bonded_pair();
    struct dem_setup setup = soft_setup(&packing);
    setup.fixed = first_fixed;
    struct dem *dem = create(&setup);
    const double force = 1e-9;
    push(dem, 1, (struct vector){force, 0, 0});
    settle(dem, 1e-10);
    const struct vector u = displacement_of(dem, 1);
    assert_close(u.x, force / (8e14 * bond_area()), 1e-8);
    assert_true(u.y == 0 && u.z == 0);
    dem_free(dem);
    packing_free(&packing);
}

// In compression the contact helps: half a grain's stiffness beside the bond's.
TEST(compression_stiffness)
{
    struct packing packing = bonded_pair();
    struct dem_setup setup = soft_setup(&packing);
    setup.fixed = first_fixed;
    struct dem *dem = create(&setup);
    const double force = -1e-9;
    push(dem, 1, (struct vector){force, 0, 0});
    settle(dem, 1e-10);
    assert_close(displacement_of(dem, 1).x, force / (10 + 8e14 * bond_area()), 1e-8);
    dem_free(dem);
    packing_free(&packing);
}

TEST(shear_stiffness)
{
    struct packing packing = bonded_pair();
    struct dem_setup setup = soft_setup(&packing);
    setup.fixed = first_fixed;
    struct dem *dem = create(&setup);
    const double force = 1e-12; // the plane turns by u/2R = 1e-7
    push(dem, 1, (struct vector){0, 0, force});
    settle(dem, 1e-10);
    const double wanted = force / (5e14 * bond_area()) +
                          force * RADIUS * RADIUS / (8e14 * bending_inertia());
    assert_close(displacement_of(dem, 1).z, wanted, 1e-6);
    dem_free(dem);
    packing_free(&packing);
}

// A force that stays FRACTION of what breaks the bond, and what came of it.
static struct dem_crack pull_to(struct vector breaking, double fraction,
                                double normal_strength, double shear_strength,
                                int *n_crack)
{
    struct packing packing = bonded_pair();
    struct dem_setup setup = soft_setup(&packing);
    setup.fixed = first_fixed;
    setup.bond.normal_strength = normal_strength;
    setup.bond.shear_strength = shear_strength;
    struct dem *dem = create(&setup);
    raise_force(dem, scale(fraction, breaking), 200);
    const struct dem_crack *crack = dem_cracks(dem, n_crack);
    const struct dem_crack first = *n_crack > 0 ? crack[0] : (struct dem_crack){0};
    uint8_t intact;
    dem_bonds_intact(dem, &intact);
    assert_int_equal(intact, *n_crack == 0);
    dem_free(dem);
    packing_free(&packing);
    return first;
}

static void assert_breaks_at(struct vector breaking, double normal_strength,
                             double shear_strength, int mode)
{
    int n_crack;
    pull_to(breaking, 0.995, normal_strength, shear_strength, &n_crack);
    assert_int_equal(n_crack, 0);
    const struct dem_crack crack =
        pull_to(breaking, 1.005, normal_strength, shear_strength, &n_crack);
    assert_int_equal(n_crack, 1);
    assert_int_equal(crack.mode, mode);
    assert_int_equal(crack.bond, 0);
    assert_close(crack.position.x, 2 * RADIUS, 1e-3);
}

TEST(breaks_in_tension)
{
    const double strength = 1.6e4;
    assert_breaks_at((struct vector){strength * bond_area(), 0, 0}, strength, strength,
                     DEM_CRACK_NORMAL);
}

TEST(breaks_in_shear)
{
    const double strength = 1.6e4;
    assert_breaks_at((struct vector){0, strength * bond_area(), 0}, INFINITY, strength,
                     DEM_CRACK_SHEAR);
}

// F r bends: sigma = F r R / I, which the shear strength does not see.
TEST(breaks_in_bending)
{
    const double strength = 1.6e4;
    const double load = strength * bending_inertia() / (RADIUS * bond_radius());
    assert_breaks_at((struct vector){0, load, 0}, strength, strength, DEM_CRACK_NORMAL);
}

// Spins that the bond takes up; the undamped rocking reaches STRENGTH at SPIN.
static struct dem *rocking(struct packing *packing, struct vector first,
                           struct vector second, double strength)
{
    *packing = bonded_pair();
    struct dem_setup setup = soft_setup(packing);
    setup.material.damping_ratio = 0;
    setup.bond.normal_strength = setup.bond.shear_strength = strength;
    setup.time_step_safety = 0.001;
    struct dem *dem = create(&setup);
    const struct vector spin[2] = {first, second};
    dem_set_velocity(dem, NULL, spin);
    return dem;
}

// Seconds until the spin of the second grain changes sign: a quarter period.
static double quarter_period(struct dem *dem, int axis)
{
    struct vector spin[2];
    dem_spins(dem, spin);
    double before = component(spin[1], axis), now = before;
    while (now > 0) {
        before = now;
        run(dem, 1);
        dem_spins(dem, spin);
        now = component(spin[1], axis);
    }
    const double steps = (double)dem_cycle(dem) + now / (before - now);
    return (steps - 0.5) * dem_time_step(dem); // spins are half a step behind
}

static void assert_rocks(struct vector first, struct vector second, int axis,
                         double stiffness, double breaking_moment, int mode)
{
    const double strength = 1.6e4;
    struct packing packing;
    struct dem *dem = rocking(&packing, first, second, INFINITY);
    // Two equal grains turn against each other: half the inertia.
    const double omega = sqrt(stiffness / (0.5 * grain_inertia()));
    assert_close(quarter_period(dem, axis), M_PI / 2 / omega, 1e-5);
    dem_free(dem);
    packing_free(&packing);

    const double amplitude = strength * breaking_moment / stiffness; // radians
    for (int k = 0; k < 2; k++) {
        const double spin = (k ? 1.002 : 0.998) * amplitude * omega / 2;
        dem = rocking(&packing, scale(spin, first), scale(spin, second), strength);
        run(dem, (int64_t)(2 * M_PI / omega / dem_time_step(dem)));
        int n_crack;
        const struct dem_crack *crack = dem_cracks(dem, &n_crack);
        assert_int_equal(n_crack, k);
        if (k) assert_int_equal(crack[0].mode, mode);
        dem_free(dem);
        packing_free(&packing);
    }
}

TEST(bending)
{
    assert_rocks((struct vector){0, -1, 0}, (struct vector){0, 1, 0}, 1,
                 8e14 * bending_inertia(), bending_inertia() / bond_radius(),
                 DEM_CRACK_NORMAL);
}

TEST(twist)
{
    const double polar = 2 * bending_inertia(); // J
    assert_rocks((struct vector){-1, 0, 0}, (struct vector){1, 0, 0}, 0, 5e14 * polar,
                 polar / bond_radius(), DEM_CRACK_SHEAR);
}

// Both limits passed in one step: the mode further past its strength.
TEST(larger_ratio_names_the_mode)
{
    int n_crack;
    const struct vector across = {1e-9, 1e-9, 0};
    struct dem_crack crack = pull_to(across, 1, 0, 1e-30, &n_crack);
    assert_int_equal(n_crack, 1);
    assert_int_equal(crack.mode, DEM_CRACK_NORMAL); // 0 is reached without any load
    crack = pull_to(across, 1, 1e-20, 1e-30, &n_crack);
    assert_int_equal(n_crack, 1);
    assert_int_equal(crack.mode, DEM_CRACK_SHEAR);
}

// A bond that breaks does nothing in the cycle in which it does [K 4.43]: grains that
// fly apart and turn go on as they were.
TEST(what_breaks_pulls_no_more)
{
    struct packing packing = bonded_pair();
    struct dem_setup setup = stiff_setup(&packing);
    setup.material.damping_ratio = 0;
    for (int mode = 0; mode < 2; mode++) {
        setup.bond.normal_strength = mode == DEM_CRACK_NORMAL ? 1e-3 : INFINITY;
        setup.bond.shear_strength = mode == DEM_CRACK_SHEAR ? 1e-3 : INFINITY;
        struct dem *dem = create(&setup);
        const struct vector velocity[2] = {{-1e-3, 2e-3, 1e-3}, {3e-3, 1e-3, -2e-3}};
        const struct vector spin[2] = {{1e3, 2e3, -1e3}, {-2e3, 1e3, 3e3}};
        dem_set_velocity(dem, velocity, spin);
        run(dem, 10);
        int n_crack;
        const struct dem_crack *crack = dem_cracks(dem, &n_crack);
        assert_int_equal(n_crack, 1);
        assert_int_equal(crack[0].mode, mode);
        struct vector after[2], turning[2];
        dem_velocities(dem, after);
        dem_spins(dem, turning);
        for (int i = 0; i < 2; i++) {
            assert_true(distance(after[i], velocity[i]) < 1e-15 * norm(velocity[i]));
            assert_true(distance(turning[i], spin[i]) < 1e-15 * norm(spin[i]));
        }
        dem_free(dem);
    }
    packing_free(&packing);
}

// K 4.41 and 4.42 ask for a stress of at least the strength: without strength a bond
// breaks at rest.
TEST(no_strength_at_all)
{
    struct packing packing = bonded_pair();
    for (int kind = 0; kind < 2; kind++)
        for (int mode = 0; mode < 2; mode++) {
            struct dem_setup setup = stiff_setup(&packing);
            setup.bond.kind = kind ? DEM_CONTACT_BOND : DEM_PARALLEL_BOND;
            setup.bond.normal_strength = mode == DEM_CRACK_NORMAL ? 0 : INFINITY;
            setup.bond.shear_strength = mode == DEM_CRACK_SHEAR ? 0 : INFINITY;
            struct dem *dem = create(&setup);
            run(dem, 1);
            int n_crack;
            const struct dem_crack *crack = dem_cracks(dem, &n_crack);
            assert_int_equal(n_crack, 1);
            assert_int_equal(crack[0].mode, mode);
            dem_free(dem);
        }
    packing_free(&packing);
}

// Pairs far from each other, swept together, each loaded its own way: one moves as it
// does alone, whatever breaks beside it.
TEST(pairs_do_not_know_each_other)
{
    enum { PAIRS = 11 };
    struct packing alone = bonded_pair(), all = new_packing(2 * PAIRS, PAIRS);
    for (int p = 0; p < PAIRS; p++)
        for (int end = 0; end < 2; end++) {
            const struct vector away = {0, 16 * p * RADIUS, 0};
            all.position[2 * p + end] = add(alone.position[end], away);
            all.bond[p][end] = 2 * p + end;
        }
    all.upper = (struct vector){4 * RADIUS, 16 * PAIRS * RADIUS, 4 * RADIUS};
    uint8_t fixed[2 * PAIRS] = {0};
    for (int p = 0; p < PAIRS; p++)
        fixed[2 * p] = 1;
    for (int kind = 0; kind < 2; kind++) {
        struct dem_setup setup = stiff_setup(&all);
        setup.fixed = fixed;
        setup.bond.kind = kind ? DEM_CONTACT_BOND : DEM_PARALLEL_BOND;
        setup.bond.normal_strength = kind ? 2e-9 : 2e4;
        setup.bond.shear_strength = kind ? 2e-9 : 2e4;
        struct dem *together = create(&setup);
        struct vector *force = random_vectors(2 * PAIRS, 4e-9, 8);
        dem_set_force(together, force);
        run(together, 700);
        int n_crack, n_alone = 0;
        dem_cracks(together, &n_crack);
        assert_in_range(n_crack, 2, PAIRS - 2);
        setup.packing = &alone;
        for (int p = 0; p < PAIRS; p++) {
            struct dem *dem = create(&setup);
            dem_set_force(dem, force + 2 * p);
            run(dem, 700);
            int n;
            dem_cracks(dem, &n);
            n_alone += n;
            const struct vector moved = displacement_of(dem, 1);
            assert_true(distance(moved, displacement_of(together, 2 * p + 1)) <=
                        1e-12 * norm(moved));
            dem_free(dem);
        }
        assert_int_equal(n_alone, n_crack);
        dem_free(together);
        free(force);
    }
    packing_free(&all);
    packing_free(&alone);
}
