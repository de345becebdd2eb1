// SPDX-License-Identifier: GPL-3.0-or-later
// The way to an equilibrium with large displacements ends in sensible time: where dense
// systems take long without being solved, and where nothing else would end it.
#include "equilibrium_scene.h"

#include "quasi_static/large/large_state.h"

// ---- all contacts at once -----------------------------------------------------------

enum { WIDE = 5, TALL = 8, MANY = WIDE * WIDE * TALL };

struct told {
    int times;
    double last;
};

static void note(void *context, double balanced)
{
    struct told *told = context;
    assert_true(balanced >= told->last && balanced < 1);
    told->last = balanced;
    told->times++;
}

// Squeezed and let go, all 465 contacts with friction come to the point where they may
// open, slide or stick, which Newton's method does not see through however near it
// begins. It comes to rest by steps in time, after few tries that take long,
// and says so all the way.
TEST(a_block_that_is_let_go)
{
    struct packing packing = cubic_lattice(WIDE, WIDE, TALL, false);
    uint8_t fixed[MANY] = {0};
    memset(fixed, 1, WIDE * WIDE);
    struct quasi_static_setup setup = setup_of(&packing, fixed);
    setup.material.friction = 0.5;
    setup.large_displacements = true;
    setup.increment = 0.02;
    setup.tolerance = 1e-8;
    struct told told = {0, 0};
    setup.report = note;
    setup.context = &told;
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    struct vector force[MANY] = {{0, 0, 0}};
    for (int i = 0; i < MANY; i++) {
        const int x = i % WIDE, y = i / WIDE % WIDE;
        const double size = 1e-7 * (1 + 0.1 * (i * 7 % 5));
        force[i].x = size * (2 - x) / 2;
        force[i].y = size * (2 - y) / 2;
        force[i].z = i >= MANY - WIDE * WIDE ? -size : 0;
    }
    next_equilibrium(equilibrium, force);
    memset(force, 0, sizeof force);
    told = (struct told){0, 0};
    next_equilibrium(equilibrium, force);
    assert_in_range(told.times, 10, equilibrium->large->work_spent);
    int last;
    print_message("# let go: %.0f tries\n", equilibrium->large->work_spent);
    assert_int_equal(quasi_static_unconverged(equilibrium, &last), 0);
    assert_true(largest_residual(equilibrium) <= 1e-8 * equilibrium->largest_load);
    assert_true(equilibrium->large->work_spent < 1500);
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

// ---- more than joints bear ----------------------------------------------------------

static struct block *new_breaking_block(void)
{
    struct block *block = new_block();
    block->setup.material.friction = 0.5;
    block->setup.bond.normal_strength = block->setup.bond.shear_strength = 1.6e4;
    block->setup.large_displacements = true;
    block->setup.increment = 0.02;
    block->setup.tolerance = 1e-8;
    return block;
}

// Forces that press the stiffest joint by a thousand radii, or by 1e39 times as many,
// take all grains that are not held away: steps in time are as short as that asks for.
TEST(forces_beyond_all_joints)
{
    const double sizes[] = {10, 1e10, 1e40};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        struct block *block = new_breaking_block();
        struct quasi_static *equilibrium = make_equilibrium(&block->setup);
        struct vector force[BLOCK];
        int grain;
        load_block(force, sizes[k]);
        next_equilibrium(equilibrium, force);
        print_message("# %g N: %.0f tries\n", sizes[k], equilibrium->large->work_spent);
        assert_int_equal(quasi_static_detached(equilibrium, &grain),
                         BLOCK - SIDE * SIDE);
        assert_int_equal(quasi_static_unconverged(equilibrium, &grain), 0);
        assert_true(equilibrium->large->work_spent < 500);
        quasi_static_free(equilibrium);
        free_block(block);
    }
}

// One that does not come to rest, bond after bond, is one load without rest.
TEST(a_load_without_rest_counts_once)
{
    struct block *block = new_breaking_block();
    block->setup.most_iterations = 1;
    struct quasi_static *equilibrium = make_equilibrium(&block->setup);
    struct vector force[BLOCK];
    int grain, cracks;
    load_block(force, -1e-4);
    next_equilibrium(equilibrium, force);
    quasi_static_cracks(equilibrium, &cracks);
    print_message("# %d bonds broke\n", cracks);
    assert_int_equal(quasi_static_unconverged(equilibrium, &grain), 1);
    quasi_static_free(equilibrium);
    free_block(block);
}

// ---- a limit ------------------------------------------------------------------------

// A row that is drawn across takes more increments than it is given here.
TEST(a_way_that_is_too_long)
{
    enum { ROW = 10 };
    struct packing packing = cubic_lattice(ROW, 1, 1, false);
    const uint8_t fixed[ROW] = {1};
    struct quasi_static_setup setup = setup_of(&packing, fixed);
    setup.large_displacements = true;
    setup.increment = 0.001;
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    struct vector force[ROW] = {{0, 0, 0}};
    struct reason reason = {""};
    force[ROW - 1].z = 1e-8;
    equilibrium->large->work_limit = 5;
    assert_int_equal(quasi_static_solve(equilibrium, force, &reason),
                     STATUS_NOT_CONVERGED);
    print_message("# %s\n", reason.text);
    double share = 0;
    assert_non_null(strstr(reason.text, "equilibrium is not reached: "));
    assert_int_equal(sscanf(strchr(reason.text, ':'), ": %lf", &share), 1);
    assert_true(share > 0 && share < 1);
    assert_non_null(strstr(reason.text, "grain 9 "));
    quasi_static_free(equilibrium);
    packing_free(&packing);
}
