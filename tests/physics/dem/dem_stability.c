// SPDX-License-Identifier: GPL-3.0-or-later
// The stability limit: a step past it is refused by name; forced, it diverges and says
// so, without a NaN; just inside, nothing grows. And input that cannot be.
#include "../dem_scene.h"
#include "../support_irregular.h"

enum { SIDE = 4, N = SIDE * SIDE * SIDE };

// A lattice pressed together so that every contact acts, given a small random shake.
static struct dem *pressed_lattice(const struct dem_setup *setup)
{
    struct dem *dem = create(setup);
    struct vector *velocity = random_vectors(N, 1e-6, 5);
    struct vector *spin = random_vectors(N, 1e-6 / RADIUS, 6);
    dem_set_velocity(dem, velocity, spin);
    free(velocity);
    free(spin);
    return dem;
}

// Periodic along all axes.
static struct packing shrunk_lattice(void)
{
    struct packing packing = cubic_lattice(SIDE, SIDE, SIDE, true);
    for (int i = 0; i < N; i++)
        packing.radius[i] *= 1 + 1e-3; // overlaps that keep contacts closed
    packing.periodic[2] = 1;
    return packing;
}

static double limit_of(struct dem_setup setup)
{
    setup.force_time_step = true;
    struct dem *dem = create(&setup);
    const double safety =
        setup.time_step_safety * dem_time_step_limit(dem) / dem_time_step(dem);
    dem_free(dem);
    return safety;
}

TEST(refused_past_the_limit)
{
    struct packing packing = shrunk_lattice();
    for (int k = 0; k < 2; k++) {
        struct dem_setup setup = stiff_setup(&packing);
        setup.material.damping_ratio = k ? 0.7 : 0;
        const double limit = limit_of(setup);
        struct reason reason = {""};
        struct dem *dem;
        setup.time_step_safety = 1.0001 * limit;
        assert_int_equal(dem_create(&dem, &setup, &reason), STATUS_NOT_CONVERGED);
        assert_null(dem);
        assert_non_null(strstr(reason.text, "stability limit"));
        setup.time_step_safety = 0.9999 * limit;
        assert_int_equal(dem_create(&dem, &setup, &reason), STATUS_OK);
        dem_free(dem);
    }
    packing_free(&packing);
}

// On the lattice the bound is nearly exact: inside it nothing grows, 3 % past it the
// shake explodes, with dashpots and without.
TEST(limit_is_where_it_breaks)
{
    struct packing packing = shrunk_lattice();
    for (int k = 0; k < 2; k++) {
        struct dem_setup setup = stiff_setup(&packing);
        setup.material.damping_ratio = k ? 0.7 : 0;
        setup.material.friction = 1e6; // nothing slips: that would take the energy away
        setup.force_time_step = true;
        const double limit = limit_of(setup);

        setup.time_step_safety = 0.98 * limit;
        struct dem *dem = pressed_lattice(&setup);
        struct reason reason = {""};
        assert_int_equal(dem_run(dem, 20000, &reason), STATUS_OK);
        dem_free(dem);

        setup.time_step_safety = 1.03 * limit;
        dem = pressed_lattice(&setup);
        assert_int_equal(dem_run(dem, 20000, &reason), STATUS_NOT_CONVERGED);
        assert_non_null(strstr(reason.text, "diverged"));
        struct vector u[N], v[N];
        dem_displacements(dem, u);
        dem_velocities(dem, v);
        for (int i = 0; i < N; i++)
            assert_true(isfinite(norm(u[i])) && isfinite(norm(v[i])));
        assert_true(dem_unbalanced_ratio(dem) >= 0);
        dem_free(dem);
    }
    packing_free(&packing);
}

TEST(nan_force_stops_the_run)
{
    struct packing packing = bonded_pair();
    struct dem_setup setup = stiff_setup(&packing);
    struct dem *dem = create(&setup);
    push(dem, 1, (struct vector){NAN, 0, 0});
    struct reason reason = {""};
    assert_int_equal(dem_run(dem, 10, &reason), STATUS_NOT_CONVERGED);
    assert_true(isfinite(displacement_of(dem, 1).x));
    dem_free(dem);
    packing_free(&packing);
}

static void assert_bad(struct dem_setup setup, const char *word)
{
    struct reason reason = {""};
    struct dem *dem;
    assert_int_equal(dem_create(&dem, &setup, &reason), STATUS_BAD_DATA);
    assert_null(dem);
    if (!strstr(reason.text, word)) fail_msg("\"%s\" lacks \"%s\"", reason.text, word);
}

TEST(bad_numbers)
{
    struct packing packing = bonded_pair();
    const struct dem_setup good = stiff_setup(&packing);
    struct dem_setup setup = good;
    setup.material.density = 0;
    assert_bad(setup, "density");
    setup = good;
    setup.material.friction = -1;
    assert_bad(setup, "friction");
    setup = good;
    setup.material.normal_stiffness = NAN;
    assert_bad(setup, "normal stiffness");
    setup = good;
    setup.bond.radius_fraction = 1.5;
    assert_bad(setup, "radius fraction");
    setup = good;
    setup.time_step_safety = 0;
    assert_bad(setup, "safety");
    setup = good;
    setup.material.normal_stiffness = setup.material.shear_stiffness = 0;
    setup.bond.normal_stiffness = setup.bond.shear_stiffness = 0;
    assert_bad(setup, "stiffness");
    setup = good;
    const struct dem_wall wall = {.point = {0, 0, 0}, .normal = {0, 0, 0}};
    setup.wall = &wall;
    setup.n_wall = 1;
    assert_bad(setup, "wall 0");
    packing_free(&packing);
}

TEST(bad_packings)
{
    struct packing packing = cubic_lattice(2, 2, 1, false);
    const struct dem_setup setup = stiff_setup(&packing);
    packing.bond[1][1] = 4;
    assert_bad(setup, "bond 1");
    packing.bond[1][1] = packing.bond[1][0];
    assert_bad(setup, "bond 1");
    memcpy(packing.bond[1], packing.bond[0], sizeof packing.bond[0]);
    assert_bad(setup, "join only");
    packing.n_bond = 0;
    packing.position[1] = packing.position[0];
    assert_bad(setup, "coincide");
    packing.position[1].x = NAN;
    assert_bad(setup, "grain 1");
    packing.position[1].x = 3 * RADIUS;
    packing.radius[2] = -1;
    assert_bad(setup, "grain 2");
    packing.radius[2] = RADIUS;
    packing.periodic[0] = 1; // each would touch the other on both sides
    assert_bad(setup, "periodic");
    packing_free(&packing);
}

TEST(few_grains)
{
    for (int n = 0; n < 2; n++) {
        struct packing packing = new_packing(n, 0);
        struct dem_setup setup = stiff_setup(&packing);
        struct dem *dem = create(&setup);
        run(dem, 10);
        assert_true(dem_unbalanced_ratio(dem) == 0);
        assert_true(dem_energy(dem).kinetic == 0);
        int n_contact;
        free(dem_contacts(dem, &n_contact));
        assert_int_equal(n_contact, 0);
        dem_free(dem);
        packing_free(&packing);
    }
}

// Whichever way the scene is turned; an irregular one, with and without dashpots.
TEST(limit_turns_along)
{
    struct packing packing = irregular_packing(SIDE, RADIUS, false);
    const struct vector axis = {1, 2, 3};
    struct packing other = turned_packing(&packing, axis, 1, NULL);
    for (int k = 0; k < 2; k++) {
        struct dem_setup setup = stiff_setup(&packing);
        setup.material.shear_stiffness = 1e4;
        setup.material.damping_ratio = k ? 0.7 : 0;
        const double limit = limit_of(setup);
        setup.packing = &other;
        assert_close(limit_of(setup), limit, 1e-11);
    }
    packing_free(&other);
    packing_free(&packing);
}
