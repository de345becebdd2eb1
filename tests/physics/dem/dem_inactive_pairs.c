// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs that are left out while they can do nothing change no byte: cycles run at once,
// where they are, against as many run one by one, where they never are.
#include "../dem_scene.h"

// Pulls that break most bonds and throw grains against each other, and then others.
static void pull(struct dem *dem, int turn)
{
    const int n = dem->n_particle;
    struct vector *force = NEW_ARRAY(struct vector, n);
    for (int i = 0; i < n; i++)
        force[i] =
            (struct vector){3e-8 * sin(7.1 * i + turn), 3e-8 * sin(3.3 * i + turn),
                            3e-8 * cos(5.7 * i - turn)};
    dem_set_force(dem, force);
    free(force);
}

// How many pairs are inactive at the end.
static int inactive_now(struct dem *dem)
{
    const int n = dem->pairs.n_pair;
    update_inactive_pairs(dem, 1000, true);
    const int inactive = n - dem->pairs.n_pair;
    reactivate_pairs(dem);
    return inactive;
}

static void check(const struct dem_setup *setup)
{
    enum { TURNS = 12, CYCLES = 400 };
    struct dem *at_once = create(setup), *one_by_one = create(setup);
    for (int turn = 0; turn < TURNS; turn++) {
        pull(at_once, turn);
        pull(one_by_one, turn);
        run(at_once, CYCLES);
        for (int k = 0; k < CYCLES; k++)
            run(one_by_one, 1);
        assert_same_state(at_once, one_by_one);
    }
    // Otherwise nothing was tested: pairs were inactive, and some of them touched
    // again.
    const double min_inactive_gap = at_once->min_inactive_gap;
    assert_true(inactive_now(at_once) > at_once->pairs.n_pair / 8);
    assert_true(min_inactive_gap > 1e-7);
    dem_free(at_once);
    dem_free(one_by_one);
}

static struct dem_setup weak_setup(const struct packing *packing, uint8_t *fixed)
{
    for (int i = 0; i < packing->n_particle; i++)
        fixed[i] = packing->position[i].z < 2 * RADIUS;
    struct dem_setup setup = stiff_setup(packing);
    setup.bond.normal_strength = setup.bond.shear_strength = 1.6e4;
    setup.fixed = fixed;
    return setup;
}

TEST(equal_grains)
{
    struct packing packing = cubic_lattice(5, 5, 8, false);
    uint8_t fixed[5 * 5 * 8];
    const struct dem_setup setup = weak_setup(&packing, fixed);
    check(&setup);
    packing_free(&packing);
}

TEST(unequal_grains_in_a_periodic_box)
{
    struct packing packing = cubic_lattice(5, 5, 8, true);
    for (int i = 0; i < packing.n_particle; i++)
        packing.radius[i] *= 1 - 0.01 * (i % 7);
    uint8_t fixed[5 * 5 * 8];
    struct dem_setup setup = weak_setup(&packing, fixed);
    setup.threads = 2;
    check(&setup);
    packing_free(&packing);
}
