// SPDX-License-Identifier: GPL-3.0-or-later
// Drying shrinkage of grains and their bonds, against closed forms. With k = k^n A of a
// bond, l = 2 R and a shrinkage e: a bond between grains held apart carries k l e and
// breaks at e = strength / (k^n l); a free body shrinks by e and carries nothing; a bar
// of n grains whose ends are held and do not shrink is stretched by (n - 2) l e over
// its n - 1 bonds.
#include "../dem_scene.h"

static const double strain = 1e-4;

static double bond_stiffness(void)
{
    return 8e14 * M_PI * pow(0.5858 * RADIUS, 2);
}

static void shrink_all(struct dem *dem, int n, double e)
{
    double *shrinkage = NEW_ARRAY(double, n);
    for (int i = 0; i < n; i++)
        shrinkage[i] = e;
    dem_set_shrinkage(dem, shrinkage);
    free(shrinkage);
}

static struct dem_setup shrinking_setup(const struct packing *packing)
{
    struct dem_setup setup = stiff_setup(packing);
    setup.shrinks = true;
    setup.unstressed = true;
    // A soft contact, as dashpots and time step go by it and most tests by the bond.
    setup.material.normal_stiffness = setup.material.shear_stiffness = 20;
    setup.material.damping_ratio = 0.5;
    setup.time_step_safety = NAN;
    return setup;
}

// The force on the second grain of contact K, along x.
static double force_along_x(const struct dem *dem, int k)
{
    int n;
    struct dem_contact *contact = dem_contacts(dem, &n);
    assert_true(k < n);
    const double force = contact[k].force.x;
    free(contact);
    return force;
}

TEST(held_pair_is_pulled)
{
    static const uint8_t fixed[2] = {1, 1};
    for (int kind = 0; kind < 2; kind++) {
        struct packing packing = bonded_pair();
        struct dem_setup setup = shrinking_setup(&packing);
        setup.fixed = fixed;
        setup.bond.kind = kind ? DEM_CONTACT_BOND : DEM_PARALLEL_BOND;
        struct dem *dem = create(&setup);
        run(dem, 1);
        assert_true(force_along_x(dem, 0) == 0);
        shrink_all(dem, 2, strain);
        run(dem, 1);
        const double stiffness = kind ? 10 : bond_stiffness();
        assert_close(force_along_x(dem, 0), -stiffness * 2 * RADIUS * strain, 1e-12);
        dem_free(dem);
        packing_free(&packing);
    }
}

TEST(breaks_at_the_strain_of_its_strength)
{
    static const uint8_t fixed[2] = {1, 1};
    const double strength = 1.6e4, limit = strength / (8e14 * 2 * RADIUS);
    struct packing packing = bonded_pair();
    struct dem_setup setup = shrinking_setup(&packing);
    setup.fixed = fixed;
    setup.bond.normal_strength = strength;
    struct dem *dem = create(&setup);
    int n_crack;
    for (int k = 0; k < 2; k++) {
        shrink_all(dem, 2, (k ? 1 + 1e-9 : 1 - 1e-9) * limit);
        run(dem, 2);
        const struct dem_crack *crack = dem_cracks(dem, &n_crack);
        assert_int_equal(n_crack, k);
        if (k) assert_int_equal(crack[0].mode, DEM_CRACK_NORMAL);
    }
    dem_free(dem);
    packing_free(&packing);
}

TEST(free_body_shrinks_without_force)
{
    struct packing packing = cubic_lattice(6, 3, 2, false);
    struct dem_setup setup = shrinking_setup(&packing);
    struct dem *dem = create(&setup);
    for (int k = 1; k <= 10; k++) {
        shrink_all(dem, packing.n_particle, strain * k / 10);
        run(dem, 10000);
    }
    const struct vector middle = scale(0.5, packing.upper);
    for (int i = 0; i < packing.n_particle; i++) {
        const struct vector at = subtract(packing.position[i], middle);
        assert_true(distance(displacement_of(dem, i), scale(-strain, at)) <
                    1e-6 * strain * RADIUS);
    }
    int n;
    struct dem_contact *contact = dem_contacts(dem, &n);
    for (int k = 0; k < n; k++)
        assert_true(norm(contact[k].force) <
                    1e-6 * bond_stiffness() * 2 * RADIUS * strain);
    free(contact);
    dem_free(dem);
    packing_free(&packing);
}

TEST(unequal_grains_shrink_each_by_itself)
{
    struct packing packing = bonded_pair();
    packing.radius[1] = 2 * RADIUS;
    packing.position[1].x += RADIUS;
    packing.upper = (struct vector){6 * RADIUS, 4 * RADIUS, 4 * RADIUS};
    struct dem_setup setup = shrinking_setup(&packing);
    static const uint8_t fixed[2] = {1, 0};
    setup.fixed = fixed;
    struct dem *dem = create(&setup);
    const double shrinkage[2] = {strain, 3 * strain};
    dem_set_shrinkage(dem, shrinkage);
    run(dem, 5000);
    assert_close(displacement_of(dem, 1).x, -(1 + 2 * 3) * RADIUS * strain, 1e-6);
    dem_free(dem);
    packing_free(&packing);
}

TEST(held_bar)
{
    enum { N = 9 };
    struct packing packing = cubic_lattice(N, 1, 1, false);
    uint8_t fixed[N] = {0};
    fixed[0] = fixed[N - 1] = 1;
    double shrinkage[N] = {0};
    for (int i = 1; i < N - 1; i++)
        shrinkage[i] = strain;
    struct dem_setup setup = shrinking_setup(&packing);
    setup.fixed = fixed;
    struct dem *dem = create(&setup);
    dem_set_shrinkage(dem, shrinkage);
    run(dem, 20000);
    const double force = bond_stiffness() * (N - 2) * 2 * RADIUS * strain / (N - 1);
    for (int k = 0; k < N - 1; k++)
        assert_close(force_along_x(dem, k), -force, 1e-8);
    dem_free(dem);
    packing_free(&packing);
}

// Between two grains that are not bonded: pressed together by F they lie as deep in
// each other as with the smaller radii.
TEST(contacts_follow_the_radii)
{
    struct packing packing = bonded_pair();
    packing.n_bond = 0;
    struct dem_setup setup = shrinking_setup(&packing);
    static const uint8_t fixed[2] = {1, 0};
    setup.fixed = fixed;
    struct dem *dem = create(&setup);
    shrink_all(dem, 2, strain);
    push(dem, 1, (struct vector){-1e-11, 0, 0});
    run(dem, 20000);
    assert_close(displacement_of(dem, 1).x, -2 * RADIUS * strain - 1e-11 / 10, 1e-8);
    double radius[2];
    dem_radii(dem, radius);
    assert_close(radius[1], RADIUS * (1 - strain), 1e-15);
    dem_free(dem);
    packing_free(&packing);
}

// kinetic + elastic + lost = gained, from nothing: breaking bonds, dashpots, and the
// work of shrinking.
TEST(energy_balances)
{
    struct packing packing = cubic_lattice(5, 4, 3, false);
    struct dem_setup setup = shrinking_setup(&packing);
    uint8_t *fixed = NEW_ARRAY(uint8_t, packing.n_particle);
    memset(fixed, 1, 20);
    setup.fixed = fixed;
    setup.balance_energy = true;
    setup.time_step_safety = 0.005;
    setup.bond.normal_strength = 1.6e4;
    setup.bond.shear_strength = 1.6e4;
    struct dem *dem = create(&setup);
    for (int k = 1; k <= 8; k++) {
        shrink_all(dem, packing.n_particle, k * 1e-5);
        run(dem, 400);
    }
    int n_crack;
    dem_cracks(dem, &n_crack);
    assert_in_range(n_crack, 1, packing.n_bond);
    const struct dem_energy e = dem_energy(dem);
    assert_true(e.gained > 0);
    assert_close(e.kinetic + e.elastic + e.dashpots + e.slip + e.local_damping +
                     e.broken,
                 e.gained, 2e-3);
    dem_free(dem);
    free(fixed);
    packing_free(&packing);
}

// ---- the same bytes -----------------------------------------------------------------

// A layer on held grains, which cracks.
static struct dem *layer(struct packing *packing, uint8_t **fixed, int threads)
{
    *packing = cubic_lattice(20, 20, 6, true);
    *fixed = NEW_ARRAY(uint8_t, packing->n_particle);
    memset(*fixed, 1, 400);
    struct dem_setup setup = shrinking_setup(packing);
    setup.fixed = *fixed;
    setup.bond.normal_strength = setup.bond.shear_strength = 1.6e4;
    setup.threads = threads;
    return create(&setup);
}

static void dry_layer(struct dem *dem, int n, int from, int to)
{
    for (int k = from; k < to; k++) {
        shrink_all(dem, n, (k + 1) * 1.5e-5);
        run(dem, 100);
    }
}

TEST(threads_and_restart_keep_the_bytes)
{
    struct packing packing[3];
    uint8_t *fixed[3];
    struct dem *dem[3];
    for (int k = 0; k < 3; k++)
        dem[k] = layer(&packing[k], &fixed[k], k == 1 ? 3 : 1);
    const int n = packing[0].n_particle;
    dry_layer(dem[0], n, 0, 3);
    int count;
    struct named_array *kept = dem_save(dem[0], &count);
    struct reason reason;
    assert_int_equal(dem_restore(dem[2], kept, count, &reason), STATUS_OK);
    dry_layer(dem[0], n, 3, 5);
    dry_layer(dem[2], n, 3, 5);
    dry_layer(dem[1], n, 0, 5);
    int n_crack;
    dem_cracks(dem[0], &n_crack);
    assert_in_range(n_crack, 10, packing[0].n_bond);
    assert_same_state(dem[0], dem[1]);
    assert_same_state(dem[0], dem[2]);
    free_arrays(kept, count);
    for (int k = 0; k < 3; k++) {
        dem_free(dem[k]);
        free(fixed[k]);
        packing_free(&packing[k]);
    }
}

// One of two grains that overlap at the start, without pushing, is pressed on the other
// again after both have shrunk and, FAR, it has been a grain's size away meanwhile: it
// comes to rest where the surfaces, nearer by what they lost, meet.
static double where_it_rests(bool far)
{
    static const uint8_t fixed[2] = {1, 0};
    static const double e = 0.02, push = 1e-10;
    struct packing packing = new_packing(2, 0);
    for (int i = 0; i < 2; i++) {
        packing.position[i] = (struct vector){1.9 * RADIUS * i, 0, 0};
        packing.radius[i] = RADIUS;
    }
    struct dem_setup setup = shrinking_setup(&packing);
    setup.fixed = fixed;
    setup.material.local_damping = 0.7;
    struct dem *dem = create(&setup);
    shrink_all(dem, 2, e);
    struct vector force[2] = {{0, 0, 0}, {push, 0, 0}},
                  moved[2] = {{0, 0, 0}, {0, 0, 0}};
    dem_set_force(dem, force);
    while (far && moved[1].x < 2 * RADIUS) {
        run(dem, 100);
        dem_displacements(dem, moved);
    }
    force[1].x = -push;
    dem_set_force(dem, force);
    while (!(dem_unbalanced_ratio(dem) < 1e-9))
        run(dem, 100);
    dem_displacements(dem, moved);
    dem_free(dem);
    packing_free(&packing);
    return moved[1].x + 2 * e * RADIUS + push / 10;
}

TEST(grains_that_come_back_meet_where_they_would_have)
{
    for (int far = 0; far < 2; far++)
        assert_within(where_it_rests(far), 0, 1e-6 * RADIUS);
}
