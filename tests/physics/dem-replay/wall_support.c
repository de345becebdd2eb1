// SPDX-License-Identifier: GPL-3.0-or-later
// Three bonded grains of different sizes on a wall, pressed on it and pushed along it:
// cycles brought to rest beside equilibria for small and for large displacements, and
// what the wall gives back.
#include "../dem_scene.h"
#include "../support_equilibrium.h"
#include "dem-replay/support_reaction.h"
#include "quasi_static/quasi_static.h"

enum { N = 3 };

static const struct vector corner = {3e-6, -2e-6, 5e-6};

// All touch the wall at the lower z side. Centres of two that touch lie 2 (r s)^(1/2)
// apart along it; these lie a little further, so that bonds alone join them.
static struct packing tripod(void)
{
    struct packing packing = new_packing(N, N);
    static const double size[N] = {1, 0.7, 0.85};
    for (int i = 0; i < N; i++) {
        packing.radius[i] = size[i] * RADIUS;
        packing.bond[i][0] = i < 2 ? i : 0;
        packing.bond[i][1] = i < 2 ? i + 1 : 2;
    }
    const double *r = packing.radius;
    const double gap = 1.05;
    const double a = gap * 2 * sqrt(r[0] * r[1]), b = gap * 2 * sqrt(r[1] * r[2]);
    const double c = gap * 2 * sqrt(r[0] * r[2]);
    const double x = (a * a + c * c - b * b) / (2 * a);
    packing.position[0] = (struct vector){0, 0, r[0]};
    packing.position[1] = (struct vector){a, 0, r[1]};
    packing.position[2] = (struct vector){x, sqrt(c * c - x * x), r[2]};
    for (int i = 0; i < N; i++)
        packing.position[i] =
            add(packing.position[i],
                add(corner, (struct vector){2 * RADIUS, 2 * RADIUS, 0}));
    packing.lower = corner;
    packing.upper = add(corner, (struct vector){7 * RADIUS, 7 * RADIUS, 7 * RADIUS});
    return packing;
}

static const uint8_t free_all[N] = {0};

// The tripod, let SUNK radii of its largest grain into the wall.
static struct packing sunk_tripod(double sunk)
{
    struct packing packing = tripod();
    for (int i = 0; i < N; i++)
        packing.position[i].z -= sunk * RADIUS;
    return packing;
}

static struct quasi_static_setup setup_of(const struct packing *packing)
{
    return (struct quasi_static_setup){
        .packing = packing,
        .fixed = free_all,
        .has_wall = true,
        .unstressed = true,
        .material = {.normal_stiffness = 300, .shear_stiffness = 200, .friction = 1e6},
        .bond = {.normal_stiffness = 2e15,
                 .shear_stiffness = 1e15,
                 .normal_strength = INFINITY,
                 .shear_strength = INFINITY,
                 .radius_fraction = 0.5858},
        .tolerance = 1e-10,
        .most_iterations = 40,
        .increment = 0.002};
}

// Pressed and pushed, turned about the upright as well; SIZE N.
static void load(struct vector force[N], double size)
{
    force[0] = (struct vector){0.3 * size, 0.1 * size, -size};
    force[1] = (struct vector){0.1 * size, 0.4 * size, -0.8 * size};
    force[2] = (struct vector){0.2 * size, -0.1 * size, -1.2 * size};
}

// That load and reaction are in balance, within SHARE; about the lower corner, the load
// where the grains ARE.
static void assert_balanced(const struct packing *packing, const struct vector *force,
                            const struct vector *are, struct net_load reaction,
                            double share)
{
    double total = 0, lever = 0;
    for (int i = 0; i < N; i++) {
        const struct vector from = subtract(are[i], packing->lower);
        const struct vector moment = cross(from, force[i]);
        reaction.force = add(reaction.force, force[i]);
        reaction.moment = add(reaction.moment, moment);
        total += norm(force[i]);
        lever += norm(moment);
    }
    assert_true(norm(reaction.force) < share * total);
    assert_true(norm(reaction.moment) < share * lever);
}

// Where cycles end under a load that grows slowly; the wall's reaction then.
static void cycles_to_rest(const struct packing *packing, double size, int steps,
                           struct vector moved[N])
{
    const struct quasi_static_setup as = setup_of(packing);
    const struct dem_wall wall = {.point = packing->lower, .normal = {0, 0, 1}};
    struct dem_setup setup = {.packing = packing,
                              .material = as.material,
                              .bond = as.bond,
                              .fixed = free_all,
                              .unstressed = as.unstressed,
                              .n_wall = 1,
                              .wall = &wall,
                              .time_step_safety = 0.02,
                              .threads = 1};
    setup.material.density = 3230;
    setup.material.damping_ratio = 0.7;
    setup.material.local_damping = 0.3;
    struct dem *dem = create(&setup);
    struct vector force[N], are[N];
    // Pressed before it is pushed on: nothing may lift off while it still swings.
    for (int step = 0; step <= steps; step++) {
        load(force, size * fmax(0.01, (double)step / steps));
        dem_set_force(dem, force);
        if (step == 0) settle(dem, 1e-9);
        run(dem, 50);
    }
    settle(dem, 1e-11);
    dem_displacements(dem, moved);
    dem_positions(dem, are);
    const struct net_load reaction = reaction_of_dem(packing, dem, free_all, true);
    assert_balanced(packing, force, are, reaction, 1e-9);
    dem_free(dem);
}

// How far both are apart, of the furthest way; displacements of up to DEPTH radii.
static double error_of(double size, int steps, bool large, double sunk, double *depth)
{
    struct packing packing = sunk_tripod(sunk);
    struct quasi_static_setup setup = setup_of(&packing);
    setup.large_displacements = large;
    struct quasi_static *equilibrium = make_equilibrium(&setup);
    struct vector force[N], still[N], moved[N];
    load(force, size);
    next_equilibrium(equilibrium, force);
    quasi_static_displacements(equilibrium, moved);
    cycles_to_rest(&packing, size, steps, still);
    if (!large) {
        const struct net_load reaction =
            reaction_of_equilibrium(&packing, equilibrium, free_all, force);
        assert_balanced(&packing, force, packing.position, reaction, 1e-9);
    }
    double most = 0, error = 0;
    for (int i = 0; i < N; i++) {
        most = fmax(most, norm(still[i]));
        error = fmax(error, distance(still[i], moved[i]));
    }
    *depth = most / RADIUS;
    quasi_static_free(equilibrium);
    packing_free(&packing);
    return error / most;
}

static void assert_engines_agree(double size, int steps, bool large, double sunk,
                                 double least_depth, double tolerance)
{
    double depth;
    const double error = error_of(size, steps, large, sunk, &depth);
    print_message("# moved by %g radii: engines %g apart\n", depth, error);
    assert_true(depth > least_depth);
    assert_true(error < tolerance);
}

TEST(small_displacements)
{
    assert_engines_agree(1e-13, 200, false, 0, 0, 1e-6);
}

TEST(large_displacements)
{
    assert_engines_agree(2e-6, 2000, true, 0, 0.02, 1e-5);
}

// The contact point is halfway into what wall and grain share, also where that does not
// push.
TEST(grains_that_reach_into_the_wall)
{
    assert_engines_agree(1e-13, 200, false, 0.2, 0, 1e-6);
}

// Each comes down by what its radius loses, as grains do that only touch the wall.
TEST(shrinks_on_the_wall)
{
    struct packing packing = sunk_tripod(0.05);
    packing.n_bond = 0;
    const struct quasi_static_setup as = setup_of(&packing);
    const struct dem_wall wall = {.point = packing.lower, .normal = {0, 0, 1}};
    struct dem_setup setup = {.packing = &packing,
                              .material = as.material,
                              .unstressed = true,
                              .shrinks = true,
                              .n_wall = 1,
                              .wall = &wall,
                              .time_step_safety = 0.02,
                              .threads = 1};
    setup.material.density = 3230;
    setup.material.local_damping = 0.7;
    struct dem *dem = create(&setup);
    const double shrinkage[N] = {0.01, 0.02, 0.03}, pressure = 1e-12;
    struct vector force[N], moved[N];
    for (int i = 0; i < N; i++)
        force[i] = (struct vector){0, 0, -pressure};
    dem_set_force(dem, force);
    dem_set_shrinkage(dem, shrinkage);
    settle(dem, 1e-9);
    dem_displacements(dem, moved);
    for (int i = 0; i < N; i++)
        assert_within(moved[i].z, -shrinkage[i] * packing.radius[i] - pressure / 300,
                      1e-9 * RADIUS);
    dem_free(dem);
    packing_free(&packing);
}
