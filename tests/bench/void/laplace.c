// SPDX-License-Identifier: GPL-3.0-or-later
// Effective diffusivity of the void of a packing, from Laplace's equation in the void
// itself: the reference for the networks' conductances.
//
//     laplace PACKING.h5 [CELLS...]
//
// Unknowns: the potential phi in the middle of each cell of a grid, less the coordinate
// x along which its mean gradient is 1. In each cell the fluxes out of its six faces
// balance,
//     sum of g (phi - phi_other) = 0,   g = open area / spacing;
// grains let nothing through. Where the box ends in walls, they are tight, or, across
// them, at phi = x, which by symmetry is what repeating the mirrored packing gives.
// Then
//     D = sum over faces of g (phi - phi_other)^2 / volume,
// relative to the free fluid. [Ng, Min & Gibou 2009 have this scheme and its order, 2
// where the boundary is smooth.]
//
// CELLS of the cube root of the volume along it, three times, by default 96 136 192.
// Prints one line of JSON with D along x, y, z for each, its limit and the error of
// this.
#include "support_extrapolate.h"
#include "support_multigrid.h"

#include "artifacts/artifact.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "sparse/conjugate_gradients.h"

#include <stdio.h>
#include <stdlib.h>

static const double tolerance = 1e-6; // of the residual; D is then good to its square

static void multiply(void *context, const double *x, double *product)
{
    const struct multigrid *multigrid = context;
    conduct(&multigrid->level[0], (double *)x, product); // writes only the layer around
}

static void precondition(void *context, const double *residual, double *z)
{
    multigrid_cycle(context, residual, z);
}

// The way from the middle of the cell below a face to that of the cell above it.
static double way(const struct grid *grid, int along, int face)
{
    const bool in_wall =
        !grid->periodic[along] && (face == 1 || face == grid->n[along] + 1);
    return in_wall ? 0.5 * grid->spacing[along] : grid->spacing[along];
}

// What a gradient of 1 along ALONG brings into each cell.
static double *right_side(const struct grid *grid, const struct level *level, int along)
{
    double *right = NEW_ARRAY(double, level->size);
    const float *g = level->conductance[along];
    const size_t next = level->stride[along];
    for (int k = 1; k <= grid->n[2]; k++)
        for (int j = 1; j <= grid->n[1]; j++)
            for (int i = 1; i <= grid->n[0]; i++) {
                const size_t c = cell_at(grid, i, j, k);
                const int place[3] = {i, j, k}, face = place[along];
                right[c] = g[c + next] * way(grid, along, face + 1) -
                           g[c] * way(grid, along, face);
            }
    return right;
}

// Sum of g (difference of phi)^2 over the faces.
static double energy(const struct grid *grid, const struct level *level, int along,
                     const double *x)
{
    double sum = 0;
    for (int a = 0; a < 3; a++)
        for (int k = 1; k <= grid->n[2] + (a == 2); k++)
            for (int j = 1; j <= grid->n[1] + (a == 1); j++)
                for (int i = 1; i <= grid->n[0] + (a == 0); i++) {
                    const int place[3] = {i, j, k}, face = place[a];
                    if (face == grid->n[a] + 1 && grid->periodic[a]) continue;
                    const size_t c = cell_at(grid, i, j, k);
                    const double drop = x[c] - x[c - level->stride[a]] +
                                        (a == along ? way(grid, along, face) : 0);
                    sum += level->conductance[a][c] * drop * drop;
                }
    return sum;
}

// D along ALONG, with as many iterations as it took.
static double diffusivity(const struct grid *grid, int along, int *iterations)
{
    struct multigrid multigrid = multigrid_of(grid, along);
    const struct level *level = multigrid.level;
    double *right = right_side(grid, level, along), *x = NEW_ARRAY(double, level->size);
    const int n = (int)level->size;
    struct linear_problem problem = {n, &multigrid, multiply, precondition, {0}};
    for (int w = 0; w < 3; w++)
        problem.work[w] = NEW_ARRAY(double, n);
    const double size = sqrt(sum_of_products(right, right, n));
    *iterations = conjugate_gradients(&problem, right, x, tolerance * size, 1000);
    if (sqrt(sum_of_products(right, right, n)) > tolerance * size)
        die(STATUS_NOT_CONVERGED, "laplace: %d iterations were not enough",
            *iterations);
    conduct(level, x, problem.work[0]); // for the layer around
    const double sum = energy(grid, level, along, x);
    for (int w = 0; w < 3; w++)
        free(problem.work[w]);
    free(right);
    free(x);
    multigrid_free(&multigrid);
    return sum;
}

int main(int argc, char **argv)
{
    if (argc != 2 && argc != 2 + RESOLUTIONS)
        die(STATUS_USAGE, "usage: laplace PACKING.h5 [CELLS CELLS CELLS]");
    hdf5_begin();
    struct artifact *artifact = artifact_open(argv[1], NULL);
    struct packing packing = artifact_get_packing(artifact);
    artifact_close(artifact);
    int cells[RESOLUTIONS] = {96, 136, 192};
    double value[3][RESOLUTIONS];
    for (int r = 0; r < RESOLUTIONS; r++) {
        if (argc > 2) cells[r] = atoi(argv[2 + r]);
        struct grid grid = grid_of(&packing, cells[r]);
        for (int along = 0; along < 3; along++) {
            int iterations;
            value[along][r] = diffusivity(&grid, along, &iterations);
            fprintf(stderr, "%d cells along %c: %.8f, %d iterations\n", cells[r],
                    "xyz"[along], value[along][r], iterations);
        }
        grid_free(&grid);
    }
    print_limits(void_share(&packing), cells, 3, value);
    packing_free(&packing);
    return 0;
}
