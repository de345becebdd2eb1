// SPDX-License-Identifier: GPL-3.0-or-later
// A bonded cubic lattice along its axis: E = K_n/(4R) [K 4.45] of the contacts in
// compression, with the bonds beside them; of the bonds alone in tension. Its strength.
#include "../dem_scene.h"

static const int side = 3, height = 6;

// Pulls the top layer, the bottom layer held; Young's modulus.
static double modulus(double stress, double *pair_stiffness, bool periodic)
{
    struct packing packing = cubic_lattice(side, side, height, periodic);
    struct dem_setup setup = stiff_setup(&packing);
    const int layer = side * side, n = layer * height;
    uint8_t *fixed = NEW_ARRAY(uint8_t, n);
    memset(fixed, 1, (size_t)layer);
    setup.fixed = fixed;
    struct dem *dem = create(&setup);
    struct vector *force = NEW_ARRAY(struct vector, n);
    for (int i = n - layer; i < n; i++)
        force[i].z = stress * 4 * RADIUS * RADIUS;
    dem_set_force(dem, force);
    settle(dem, 1e-10);

    const double u = displacement_of(dem, n - 1).z;
    const double strain = u / (2 * RADIUS * (height - 1));
    const double area = M_PI * pow(0.5858 * RADIUS, 2);
    *pair_stiffness = (stress < 0 ? 0.5 * 3e4 : 0) + 8e14 * area;
    dem_free(dem);
    free(force);
    free(fixed);
    packing_free(&packing);
    return stress / strain;
}

TEST(compression)
{
    double pair;
    const double e = modulus(-1e4, &pair, true);
    assert_close(e, pair / (2 * RADIUS), 1e-8);
    // With K_n of a grain, and a bond of 0.4 % beside it.
    assert_close(e, 3e4 / (4 * RADIUS), 4e-3);
}

TEST(tension)
{
    double pair;
    const double e = modulus(1e3, &pair, true);
    assert_close(e, pair / (2 * RADIUS), 1e-5); // strain 1e-5 turns no normal
}

TEST(free_sides_make_no_difference)
{
    double pair;
    const double e = modulus(-1e4, &pair, false);
    assert_close(e, pair / (2 * RADIUS), 1e-8);
}

// Contact bonds of strength F hold a pull of F/(4R^2) [K 4.46]. Each increment is
// followed by as much again, as a load that comes at once may stretch what it pulls
// twice as far.
TEST(strength)
{
    const double strength = 1e-6;
    struct packing packing = cubic_lattice(side, side, height, true);
    struct dem_setup setup = stiff_setup(&packing);
    setup.bond = (struct dem_bond_material){.kind = DEM_CONTACT_BOND,
                                            .normal_strength = strength,
                                            .shear_strength = strength};
    const int layer = side * side, n = layer * height;
    uint8_t *fixed = NEW_ARRAY(uint8_t, n);
    memset(fixed, 1, (size_t)layer);
    setup.fixed = fixed;
    struct dem *dem = create(&setup);
    struct vector *force = NEW_ARRAY(struct vector, n);
    int n_crack;
    for (double left = 0.5; left > 1e-3; left /= 2) {
        for (int i = n - layer; i < n; i++)
            force[i].z = (1 - left) * strength;
        dem_set_force(dem, force);
        settle(dem, 1e-8);
        dem_cracks(dem, &n_crack);
        assert_int_equal(n_crack, 0);
    }
    for (int i = n - layer; i < n; i++)
        force[i].z = (1 + 1e-3) * strength;
    dem_set_force(dem, force);
    run(dem, 20000);
    const struct dem_crack *crack = dem_cracks(dem, &n_crack);
    assert_true(n_crack >= layer);
    for (int k = 0; k < n_crack; k++)
        assert_int_equal(crack[k].mode, DEM_CRACK_NORMAL);
    dem_free(dem);
    free(force);
    free(fixed);
    packing_free(&packing);
}

// As many pairs as the lattice has bonds: diagonals are further than the skin.
TEST(pairs_of_the_lattice)
{
    struct packing packing = cubic_lattice(5, 5, 10, false);
    assert_int_equal(packing.n_bond, 625);
    struct dem_setup setup = stiff_setup(&packing);
    struct dem *dem = create(&setup);
    assert_int_equal(dem->pairs.n_pair, 625);
    int n_contact;
    struct dem_contact *contact = dem_contacts(dem, &n_contact);
    assert_int_equal(n_contact, 625);
    for (int k = 0; k < n_contact; k++) {
        assert_true(contact[k].overlap == 0); // not the rounding of coordinates
        assert_int_equal(contact[k].bond >= 0, 1);
        const int32_t *pair = contact[k].particle, *last = pair;
        if (k > 0) last = contact[k - 1].particle; // by first, then second grain
        assert_true(k == 0 || last[0] < pair[0] ||
                    (last[0] == pair[0] && last[1] < pair[1]));
    }
    free(contact);
    dem_free(dem);
    packing_free(&packing);
}
