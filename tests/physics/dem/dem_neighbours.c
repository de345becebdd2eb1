// SPDX-License-Identifier: GPL-3.0-or-later
// The search never misses a contact, whatever the box and however the grains fly, and a
// search more or less changes nothing.
#include "../dem_scene.h"

enum { N = 200 };

// Unequal grains here and there in a box, no two touching, flying about.
static struct packing gas(const uint8_t periodic[3])
{
    struct packing packing = new_packing(N, 0);
    const double box = 20 * RADIUS;
    struct vector *at = random_vectors(100 * N, box / 2, 21);
    uint64_t seed = 22;
    for (int i = 0, k = 0; i < N; k++) {
        assert_true(k < 100 * N);
        packing.radius[i] = RADIUS * (1 + 0.5 * next_signed(&seed));
        packing.position[i] = at[k];
        bool touches = false;
        for (int j = 0; j < i && !touches; j++) {
            struct vector apart = subtract(at[k], packing.position[j]);
            for (int axis = 0; axis < 3; axis++) {
                double x = component(apart, axis);
                if (periodic[axis]) x -= box * rint(x / box);
                set_component(&apart, axis, x);
            }
            touches = norm(apart) < packing.radius[i] + packing.radius[j];
        }
        i += !touches;
    }
    free(at);
    packing.lower = (struct vector){-box / 2, -box / 2, -box / 2};
    packing.upper = scale(-1, packing.lower);
    memcpy(packing.periodic, periodic, 3);
    return packing;
}

// One grain of EVERY flies.
static struct dem *flying(const struct packing *packing, int every)
{
    struct dem_setup setup = stiff_setup(packing);
    struct dem *dem = create(&setup);
    struct vector *velocity = random_vectors(N, 100, 23);
    for (int i = 0; i < N; i++)
        if (i % every > 0) velocity[i] = (struct vector){0, 0, 0};
    dem_set_velocity(dem, velocity, NULL);
    free(velocity);
    return dem;
}

static int touching_by_brute_force(const struct packing *packing, const struct dem *dem)
{
    struct vector position[N];
    dem_positions(dem, position);
    const double box = packing->upper.x - packing->lower.x;
    int n = 0;
    for (int i = 0; i < N; i++)
        for (int j = 0; j < i; j++) {
            struct vector apart = subtract(position[i], position[j]);
            for (int axis = 0; axis < 3; axis++) {
                double x = component(apart, axis);
                if (packing->periodic[axis]) x -= box * rint(x / box);
                set_component(&apart, axis, x);
            }
            n += norm(apart) <= packing->radius[i] + packing->radius[j];
        }
    return n;
}

static int touching(const struct dem *dem)
{
    int n = 0;
    for (int p = 0; p < dem->pairs.n_pair; p++)
        n += pair_geometry(dem, p, 0).overlap >= 0;
    return n;
}

// Grains at rest have a shallower skin than those that fly.
TEST(no_contact_is_missed)
{
    const uint8_t periodic[3][3] = {{0, 0, 0}, {1, 1, 0}, {1, 1, 1}};
    for (int k = 0; k < 6; k++) {
        struct packing packing = gas(periodic[k / 2]);
        struct dem *dem = flying(&packing, k % 2 ? 5 : 1);
        int met = 0;
        for (int step = 0; step < 100; step++) {
            run(dem, 40);
            const int n = touching(dem);
            assert_int_equal(n, touching_by_brute_force(&packing, dem));
            met += n;
        }
        assert_true(met > (k % 2 ? 20 : 100));
        dem_free(dem);
        packing_free(&packing);
    }
}

TEST(another_search_changes_nothing)
{
    const uint8_t periodic[3] = {1, 1, 0};
    struct packing packing = gas(periodic);
    struct dem *rare = flying(&packing, 1), *often = flying(&packing, 1);
    for (int step = 0; step < 300; step++) {
        find_pairs(often);
        run(often, 7);
        run(rare, 7);
    }
    for (int i = 0; i < N; i++) {
        assert_memory_equal(velocity_of(rare, i), velocity_of(often, i),
                            4 * sizeof(double));
        assert_memory_equal(spin_of(rare, i), spin_of(often, i), 4 * sizeof(double));
    }
    dem_free(rare);
    dem_free(often);
    packing_free(&packing);
}
