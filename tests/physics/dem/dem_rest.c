// SPDX-License-Identifier: GPL-3.0-or-later
// Overlaps that are taken to be at rest: they push nothing, and what presses grains
// closer meets the springs of touching ones, in both engines.
#include "../dem_scene.h"
#include "../support_equilibrium.h"

static const double overlap = 2e-3; // of the diameter

// A lattice whose grains all overlap.
static struct packing squeezed_lattice(int nx, int ny, int nz)
{
    struct packing packing = cubic_lattice(nx, ny, nz, false);
    for (int i = 0; i < packing.n_particle; i++)
        packing.position[i] = scale(1 - overlap, packing.position[i]);
    return packing;
}

static double furthest(const struct dem *dem)
{
    double most = 0;
    for (int i = 0; i < dem->n_particle; i++)
        most = fmax(most, norm(displacement_of(dem, i)));
    return most;
}

TEST(nothing_moves)
{
    struct packing packing = squeezed_lattice(3, 3, 3);
    const struct dem_wall floor = {.point = {0, 0, 0}, .normal = {0, 0, 1}};
    struct dem_setup setup = stiff_setup(&packing);
    setup.bond.normal_strength = setup.bond.shear_strength = 1; // Pa
    setup.n_wall = 1; // the lowest grains are 2e-3 radii in it
    setup.wall = &floor;
    setup.unstressed = true;
    struct dem *dem = create(&setup);
    run(dem, 100);
    assert_true(furthest(dem) == 0);
    assert_true(dem_energy(dem).elastic == 0);
    dem_free(dem);

    setup.unstressed = false;
    dem = create(&setup);
    run(dem, 100);
    assert_true(furthest(dem) > 1e-4 * RADIUS);
    int n_crack;
    dem_cracks(dem, &n_crack);
    assert_true(n_crack > 0);
    dem_free(dem);
    packing_free(&packing);
}

// As a row of touching grains: pushed by F the last moves by (N-1) F / (k^n A + K/2).
TEST(a_row_is_a_row_of_springs)
{
    enum { N = 5 };
    struct packing packing = squeezed_lattice(N, 1, 1);
    const uint8_t fixed[N] = {1};
    const double f = 1e-9;
    struct dem_setup setup = stiff_setup(&packing);
    setup.unstressed = true;
    setup.fixed = fixed;
    const double glue = 8e14 * M_PI * pow(0.5858 * RADIUS, 2);
    const double expected = -(N - 1) * f / (glue + 3e4 / 2);

    struct dem *dem = create(&setup);
    push(dem, N - 1, (struct vector){-f, 0, 0});
    settle(dem, 1e-9);
    assert_true(fabs(displacement_of(dem, N - 1).x / expected - 1) < 1e-6);
    dem_free(dem);

    const struct quasi_static_setup still = {.packing = &packing,
                                             .fixed = fixed,
                                             .unstressed = true,
                                             .material = setup.material,
                                             .bond = setup.bond,
                                             .tolerance = 1e-10,
                                             .most_iterations = 40};
    struct quasi_static *equilibrium = make_equilibrium(&still);
    const struct vector force[N] = {[N - 1] = {-f, 0, 0}};
    struct vector moved[N];
    next_equilibrium(equilibrium, force);
    quasi_static_displacements(equilibrium, moved);
    assert_true(fabs(moved[N - 1].x / expected - 1) < 1e-9);
    quasi_static_free(equilibrium);
    packing_free(&packing);
}

// Arms that add up to the distance, though not to the radii less the overlap that
// pushes: the torques of each pair cancel.
TEST(momentum)
{
    struct packing packing = squeezed_lattice(4, 4, 4);
    for (int i = 0; i < packing.n_particle; i++)
        packing.radius[i] *= 1 + 1e-3 * (i % 3);
    struct dem_setup setup = stiff_setup(&packing);
    setup.unstressed = true;
    keeps_momentum(setup, 1e-2);
    packing_free(&packing);
}
