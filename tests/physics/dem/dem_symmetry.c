// SPDX-License-Identifier: GPL-3.0-or-later
// What must make no difference: how the scene is turned or numbered, its scale, threads
// and the width of the processor's registers.
#include "../dem_scene.h"

#include "basics/cpu_features.h"

enum { SIDE = 4, N = SIDE * SIDE * SIDE };

// Loads that break some bonds and make some contacts slip.
static struct dem *loaded(const struct dem_setup *setup, const struct vector *force)
{
    struct dem *dem = create(setup);
    dem_set_force(dem, force);
    return dem;
}

static struct dem_setup weak_setup(const struct packing *packing)
{
    struct dem_setup setup = stiff_setup(packing);
    setup.bond.normal_strength = setup.bond.shear_strength = 1e3;
    return setup;
}

static int cracks_of(const struct dem *dem)
{
    int n;
    dem_cracks(dem, &n);
    return n;
}

static void assert_same_bytes(const struct dem *a, const struct dem *b)
{
    const size_t n = (size_t)a->n_particle;
    assert_memory_equal(a->place, b->place, n * sizeof *a->place);
    assert_memory_equal(a->velocity, b->velocity, 8 * n * sizeof(double)); // and spins
    assert_memory_equal(a->pairs.group, b->pairs.group,
                        (size_t)a->pairs.n_group * sizeof *a->pairs.group);
    assert_int_equal(cracks_of(a), cracks_of(b));
    for (int k = 0; k < cracks_of(a); k++) {
        const struct dem_crack *p = &a->crack[k], *q = &b->crack[k];
        assert_true(p->bond == q->bond && p->mode == q->mode && p->cycle == q->cycle);
        assert_memory_equal(&p->position, &q->position, sizeof p->position);
    }
}

TEST(threads_make_no_difference)
{
    struct packing packing = cubic_lattice(14, 14, 14, false);
    struct vector *force = random_vectors(packing.n_particle, 5e-10, 11);
    const int threads[4] = {1, 2, 3, 7};
    struct dem *dem[4];
    for (int k = 0; k < 4; k++) {
        struct dem_setup setup = weak_setup(&packing);
        setup.threads = threads[k];
        dem[k] = loaded(&setup, force);
        run(dem[k], 1000);
    }
    assert_true(dem[0]->pairs.n_pair > 5000); // enough to share
    assert_in_range(cracks_of(dem[0]), 1, packing.n_bond);
    for (int k = 1; k < 4; k++)
        assert_same_bytes(dem[0], dem[k]);
    for (int k = 0; k < 4; k++)
        dem_free(dem[k]);
    free(force);
    packing_free(&packing);
}

TEST_WHERE(has_avx512(), "no wide vectors here", width_makes_no_difference)
{
    struct packing packing = cubic_lattice(SIDE, SIDE, SIDE, false);
    struct vector *force = random_vectors(N, 5e-10, 12);
    struct dem_setup setup = weak_setup(&packing);
    struct dem *dem[2];
    for (int k = 0; k < 2; k++) {
        dem[k] = loaded(&setup, force);
        const unsigned features = dem[k]->features;
        dem[k]->sweep = k ? pair_sweeps_avx512[features] : pair_sweeps_avx2[features];
        run(dem[k], 3000);
    }
    assert_in_range(cracks_of(dem[0]), 1, packing.n_bond);
    assert_same_bytes(dem[0], dem[1]);
    dem_free(dem[0]);
    dem_free(dem[1]);
    free(force);
    packing_free(&packing);
}

// Lengths times 2^20, densities by 2^-60: masses stay, stiffnesses stay, so that forces
// grow by 2^20 as the lengths do and every scaled number is the same.
TEST(scale_makes_no_difference)
{
    struct dem *dem[2];
    for (int k = 0; k < 2; k++) {
        const double length = k ? 0x1p20 : 1;
        struct packing packing = cubic_lattice(SIDE, SIDE, SIDE, false);
        for (int i = 0; i < N; i++) {
            packing.position[i] = scale(length, packing.position[i]);
            packing.radius[i] *= length;
        }
        struct dem_setup setup = weak_setup(&packing);
        setup.material.density /= length * length * length;
        setup.bond.normal_stiffness /= length * length;
        setup.bond.shear_stiffness /= length * length;
        setup.bond.normal_strength /= length;
        setup.bond.shear_strength /= length;
        struct vector *force = random_vectors(N, length * 5e-10, 13);
        dem[k] = loaded(&setup, force);
        run(dem[k], 3000);
        free(force);
        packing_free(&packing);
    }
    assert_in_range(cracks_of(dem[0]), 1, 144);
    assert_memory_equal(dem[0]->place, dem[1]->place, N * sizeof *dem[0]->place);
    assert_memory_equal(dem[0]->velocity, dem[1]->velocity, 8 * N * sizeof(double));
    assert_true(dem_time_step(dem[0]) == dem_time_step(dem[1]));
    const struct vector small = displacement_of(dem[0], 5);
    const struct vector large = displacement_of(dem[1], 5);
    assert_true(large.x == 0x1p20 * small.x && small.x != 0);
    dem_free(dem[0]);
    dem_free(dem[1]);
}

struct rotation {
    struct vector row[3];
};

static struct vector rotate(const struct rotation *r, struct vector a)
{
    return (struct vector){dot(r->row[0], a), dot(r->row[1], a), dot(r->row[2], a)};
}

static struct rotation some_rotation(void)
{
    const struct vector x = {2.0 / 3, -1.0 / 3, 2.0 / 3};
    const struct vector y = {2.0 / 3, 2.0 / 3, -1.0 / 3};
    return (struct rotation){{x, y, cross(x, y)}};
}

// Largest difference of the displacements A (turned) and B, over the largest of B.
static double difference(const struct dem *a, const struct rotation *r,
                         const struct dem *b, const int *number)
{
    double worst = 0, largest = 0;
    for (int i = 0; i < N; i++) {
        struct vector u = displacement_of(a, i);
        if (r) u = rotate(r, u);
        const struct vector v = displacement_of(b, number ? number[i] : i);
        worst = fmax(worst, distance(u, v));
        largest = fmax(largest, norm(v));
    }
    return worst / largest;
}

// Without a time for chaos: contacts that open and close part near trajectories.
TEST(rotation_turns_the_result)
{
    const struct rotation turn = some_rotation();
    struct dem *dem[2];
    for (int k = 0; k < 2; k++) {
        struct packing packing = cubic_lattice(SIDE, SIDE, SIDE, false);
        struct vector *force = random_vectors(N, 1e-9, 14);
        for (int i = 0; i < N && k; i++) {
            packing.position[i] = rotate(&turn, packing.position[i]);
            force[i] = rotate(&turn, force[i]);
        }
        struct dem_setup setup = stiff_setup(&packing);
        dem[k] = loaded(&setup, force);
        run(dem[k], 1000);
        free(force);
        packing_free(&packing);
    }
    const double off = difference(dem[0], &turn, dem[1], NULL);
    if (!(off < 1e-12)) fail_msg("turned scene differs by %g", off);
    dem_free(dem[0]);
    dem_free(dem[1]);
}

TEST(numbering_makes_no_difference)
{
    int number[N];
    for (int i = 0; i < N; i++)
        number[i] = (i * 37 + 11) % N; // a permutation, as 37 is odd
    struct dem *dem[2];
    for (int k = 0; k < 2; k++) {
        struct packing packing = cubic_lattice(SIDE, SIDE, SIDE, false);
        struct vector *force = random_vectors(N, 1e-9, 15);
        struct vector position[N], renumbered[N];
        for (int i = 0; i < N; i++) {
            position[number[i]] = packing.position[i];
            renumbered[number[i]] = force[i];
        }
        if (k) {
            memcpy(packing.position, position, sizeof position);
            memcpy(force, renumbered, sizeof renumbered);
            for (int b = 0; b < packing.n_bond; b++)
                for (int end = 0; end < 2; end++)
                    packing.bond[b][end] = number[packing.bond[b][end]];
        }
        struct dem_setup setup = stiff_setup(&packing);
        dem[k] = loaded(&setup, force);
        run(dem[k], 1000);
        free(force);
        packing_free(&packing);
    }
    const double off = difference(dem[0], NULL, dem[1], number);
    if (!(off < 1e-12)) fail_msg("renumbered scene differs by %g", off);
    dem_free(dem[0]);
    dem_free(dem[1]);
}

// A pair that spins as one about any axis keeps its history: nothing but the turned
// shear force comes back after a quarter turn.
TEST(history_turns_with_the_pair)
{
    struct packing packing = bonded_pair();
    struct dem_setup setup = stiff_setup(&packing);
    setup.material.damping_ratio = 0;
    setup.time_step_safety = 0.05;
    struct dem *dem = create(&setup);
    // Turn about y through the contact point, a quarter turn in 2000 steps.
    const int steps = 2000;
    const double spin = M_PI / 2 / (steps * dem_time_step(dem));
    const struct vector both[2] = {{0, spin, 0}, {0, spin, 0}};
    const struct vector velocity[2] = {{0, 0, spin * RADIUS}, {0, 0, -spin * RADIUS}};
    dem_set_velocity(dem, velocity, both);
    struct bond_group *g = dem->pairs.bonds;
    g->shear_force[1][0] = 1e-9; // along the axis: stays
    g->shear_force[2][0] = 2e-9; // across: from z to x
    dem->bond_shear_stiffness = 0;
    dem->bond_normal_stiffness = 100; // holds them together
    run(dem, steps);
    g = dem->pairs.bonds; // they moved far enough for a new search
    const struct vector force = lane_vector(g->shear_force, 0);
    assert_close(norm(force), sqrt(5) * 1e-9, 1e-5);
    assert_close(force.y, 1e-9, 1e-2);
    assert_close(fabs(force.x), 2e-9, 2e-2);
    dem_free(dem);
    packing_free(&packing);
}
