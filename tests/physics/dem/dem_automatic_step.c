// SPDX-License-Identifier: GPL-3.0-or-later
// The time step that nobody chose: half the stability limit, which for chains of grains
// is known in closed form; in scenes that break, scatter and gather neighbours, of
// grains one to a hundred, nothing grows, and a restart takes the same steps.
#include "../dem_scene.h"

// Grains that touch along x; a ring if closed.
static struct packing chain(int n, bool closed)
{
    struct packing packing = new_packing(n, 0);
    for (int i = 0; i < n; i++)
        packing.position[i].x = 2 * RADIUS * i;
    packing.upper = (struct vector){2 * RADIUS * n, 20 * RADIUS, 20 * RADIUS};
    packing.periodic[0] = closed;
    return packing;
}

static struct dem_setup automatic(const struct packing *packing)
{
    struct dem_setup setup = stiff_setup(packing);
    setup.time_step_safety = NAN;
    return setup;
}

// Grains of stiffness k and K that roll against each other without slip: beside each
// other they sway with 2 k/m along and 7 K/m across, in a ring with 4 k/m along; all
// turning the same way with 10 K/m. Dashpots of half a step before: dt^2 k + 2 c dt
// = 4.
static double closed_form(const struct dem_setup *setup, bool closed)
{
    const struct dem_material *material = &setup->material;
    const double mass = material->density * 4.0 / 3 * M_PI * pow(RADIUS, 3);
    const double k = 0.5 * material->normal_stiffness;
    const double across = material->friction > 0 ? 0.5 * material->shear_stiffness : 0;
    const double springs =
        fmax((closed ? 4 : 2) * k, (closed ? 10 : 7) * across) / mass;
    const double root = material->damping_ratio * sqrt(2 * mass);
    const double dashpots =
        fmax((closed ? 4 : 2) * sqrt(k), (closed ? 10 : 7) * sqrt(across)) * root /
        mass;
    return 4 / (dashpots + sqrt(dashpots * dashpots + 4 * springs));
}

TEST(chains)
{
    for (int k = 0; k < 8; k++) {
        const bool closed = k & 4;
        struct packing packing = chain(closed ? 8 : 2, closed);
        struct dem_setup setup = automatic(&packing);
        setup.material.damping_ratio = k & 1 ? 0.7 : 0;
        setup.material.friction = k & 2 ? 0.5 : 0;
        struct dem *dem = create(&setup);
        // The largest eigenvalue is had to 0.2 %, on the safe side.
        const double limit = dem_time_step_limit(dem) / closed_form(&setup, closed);
        assert_true(limit > 0.998 && limit < 1 + 1e-12);
        assert_close(dem_time_step(dem), 0.5 * dem_time_step_limit(dem), 1e-12);
        dem_free(dem);
        packing_free(&packing);
    }
}

// Pressed together, so that no contact opens: inside the limit a shake stays, past it
// it explodes.
TEST(at_the_limit)
{
    for (int k = 0; k < 4; k++) {
        struct packing packing = chain(8, true);
        struct dem_setup setup = automatic(&packing);
        setup.material.damping_ratio = k & 1 ? 0.7 : 0;
        setup.material.friction = 1e6;
        setup.time_step = (k & 2 ? 1.01 : 0.99) * closed_form(&setup, true);
        setup.force_time_step = true;
        for (int i = 0; i < packing.n_particle; i++)
            packing.radius[i] *= 1 + 1e-3;
        struct dem *dem = shaken(&setup, 1e-6, 5);
        struct reason reason = {""};
        const enum status status = dem_run(dem, 20000, &reason);
        assert_int_equal(status, k & 2 ? STATUS_NOT_CONVERGED : STATUS_OK);
        dem_free(dem);
        packing_free(&packing);
    }
}

// Grains one to a hundred, each touching one before it and overlapping none.
static struct packing cluster(int n, bool bonded)
{
    struct packing packing = new_packing(n, n - 1);
    uint64_t seed = 3;
    packing.lower = (struct vector){-1e-4, -1e-4, -1e-4};
    packing.upper = (struct vector){1e-4, 1e-4, 1e-4};
    for (int i = 0; i < n; i++)
        packing.radius[i] = RADIUS * pow(100, -next_random(&seed));
    for (int i = 1; i < n;) {
        const int j = (int)(next_random(&seed) * i);
        const double z = next_signed(&seed), turn = M_PI * next_signed(&seed);
        const double flat = sqrt(1 - z * z);
        const struct vector way = {flat * cos(turn), flat * sin(turn), z};
        packing.position[i] =
            add(packing.position[j], scale(packing.radius[i] + packing.radius[j], way));
        bool is_free = true;
        for (int k = 0; k < i && is_free; k++)
            is_free = k == j || distance(packing.position[i], packing.position[k]) >
                                    packing.radius[i] + packing.radius[k];
        packing.bond[i - 1][0] = j;
        packing.bond[i - 1][1] = i;
        i += is_free;
    }
    if (!bonded) packing.n_bond = 0;
    return packing;
}

static double energy(const struct dem *dem)
{
    const struct dem_energy all = dem_energy(dem);
    return all.kinetic + all.elastic;
}

// A copy takes the step of the moment, or that of a setup that gives one.
static void goes_on_to_the_same_bytes(struct dem *dem, const struct dem_setup *setup)
{
    struct dem_setup given = *setup;
    given.time_step = 0.9 * dem_time_step(dem);
    struct dem *copy = create(setup), *other = create(&given);
    int count, n_after;
    struct named_array *array = dem_save(dem, &count), *after[2];
    struct reason reason = {""};
    assert_int_equal(dem_restore(copy, array, count, &reason), STATUS_OK);
    assert_int_equal(dem_restore(other, array, count, &reason), STATUS_OK);
    assert_true(dem_time_step(other) == given.time_step);
    assert_true(dem_time_step(copy) == dem_time_step(dem));
    assert_close(dem_time_step_limit(copy), dem_time_step_limit(dem), 1e-15);
    free_arrays(array, count);
    run(dem, 2000);
    run(copy, 2000);
    after[0] = dem_save(dem, &count);
    after[1] = dem_save(copy, &n_after);
    assert_int_equal(count, n_after);
    for (int k = 0; k < count; k++)
        assert_memory_equal(after[0][k].data, after[1][k].data,
                            (size_t)after[0][k].count * number_size(after[0][k].type));
    for (int k = 0; k < 2; k++)
        free_arrays(after[k], count);
    dem_free(copy);
    dem_free(other);
}

// Bonds break, what breaks off scatters, contacts close that were far apart: whatever
// happens is stable, and what moves comes to less.
TEST(scenes_that_change)
{
    for (int k = 0; k < 6; k++) {
        struct packing packing = cluster(120, k & 1);
        struct dem_setup setup = automatic(&packing);
        setup.material.damping_ratio = 0.1;
        setup.material.local_damping = k & 2 ? 0.5 : 0;
        if (k & 4) setup.law = DEM_HERTZ;
        setup.material.young_modulus = 6e10;
        setup.material.poisson_ratio = 0.3;
        setup.material.restitution = 0.7;
        setup.largest_overlap = 0.1;
        setup.bond.normal_strength = setup.bond.shear_strength = 1e6;
        const double speed = k & 4 ? 30 : 300; // no deeper than the overlap above
        struct dem *dem = shaken(&setup, speed, 7);
        const double begin = energy(dem), first = dem_time_step(dem);
        for (int portion = 0; portion < 20; portion++) {
            run(dem, 1000);
            assert_true(energy(dem) < begin);
            assert_true(dem_time_step(dem) <= dem_time_step_limit_now(dem));
        }
        int cracks;
        dem_cracks(dem, &cracks);
        if (k & 1) assert_in_range(cracks, 10, packing.n_bond);
        if (!(k & 4)) assert_true(dem_time_step(dem) < first);
        goes_on_to_the_same_bytes(dem, &setup);
        dem_free(dem);
        packing_free(&packing);
    }
}
