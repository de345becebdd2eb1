// SPDX-License-Identifier: GPL-3.0-or-later
// Effective diffusivity of the void of a packing, from Laplace's equation in the void
// itself: the reference for the networks' conductances.
//
//     laplace PACKING.h5 [CELLS CELLS CELLS [FLUXES.tsv]]
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
// FLUXES.tsv gets the flux of every throat on the finest grid; PACKING.h5 then is the
// network (support_regions.h). CELLS of the cube root of the volume along it, three
// times, by default 128 181 256. Prints one line of JSON with D along x, y, z for each,
// its limit and the error of this.
#include "support_extrapolate.h"
#include "support_multigrid.h"
#include "support_regions.h"

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

// Where fluxes go to, if anywhere.
struct sink {
    struct regions regions;
    struct network network;
    struct incidence incidence;
    struct throat_fluxes fluxes;
};

// g (difference of phi)^2 of the lower face across axis A of CELL.
static double dissipated(const struct grid *grid, const struct level *level, int along,
                         const double *x, const int cell[3], int a, struct sink *sink)
{
    if (cell[a] == grid->n[a] + 1 && grid->periodic[a]) return 0;
    const size_t c = cell_at(grid, cell[0], cell[1], cell[2]);
    const double drop =
        x[c] - x[c - level->stride[a]] + (a == along ? way(grid, along, cell[a]) : 0);
    const double flux = level->conductance[a][c] * drop;
    if (sink)
        add_flux(&sink->fluxes, grid, &sink->regions, &sink->network, &sink->incidence,
                 cell, a, along, flux);
    return flux * drop;
}

// Sum of g (difference of phi)^2 over the faces.
static double energy(const struct grid *grid, const struct level *level, int along,
                     const double *x, struct sink *sink)
{
    double sum = 0;
    for (int a = 0; a < 3; a++)
        for (int k = 1; k <= grid->n[2] + (a == 2); k++)
            for (int j = 1; j <= grid->n[1] + (a == 1); j++)
                for (int i = 1; i <= grid->n[0] + (a == 0); i++) {
                    const int cell[3] = {i, j, k};
                    sum += dissipated(grid, level, along, x, cell, a, sink);
                }
    return sum;
}

// D along ALONG.
static double diffusivity(const struct grid *grid, int along, struct sink *sink)
{
    struct multigrid multigrid = multigrid_of(grid, along);
    const struct level *level = multigrid.level;
    double *right = right_side(grid, level, along), *x = NEW_ARRAY(double, level->size);
    const int n = (int)level->size;
    struct linear_problem problem = {n, &multigrid, multiply, precondition, {0}};
    for (int w = 0; w < 3; w++)
        problem.work[w] = NEW_ARRAY(double, n);
    const double size = sqrt(sum_of_products(right, right, n));
    const int steps = conjugate_gradients(&problem, right, x, tolerance * size, 1000);
    if (sqrt(sum_of_products(right, right, n)) > tolerance * size)
        die(STATUS_NOT_CONVERGED, "laplace: %d iterations were not enough", steps);
    conduct(level, x, problem.work[0]); // for the layer around
    const double sum = energy(grid, level, along, x, sink);
    for (int w = 0; w < 3; w++)
        free(problem.work[w]);
    free(right);
    free(x);
    multigrid_free(&multigrid);
    return sum;
}

static struct sink *sink_of(const struct artifact *artifact)
{
    struct sink *sink = NEW_ARRAY(struct sink, 1);
    sink->network = artifact_get_periodic_network(artifact);
    sink->incidence = network_incidence(&sink->network);
    sink->fluxes.along = allocate((size_t)sink->network.n_throat, 3 * sizeof(double));
    return sink;
}

static void finish(struct sink *sink, const char *path)
{
    fprintf(stderr, "%.2g of the fluxes between cells lead where there is no throat\n",
            sink->fluxes.stray / sink->fluxes.all);
    write_fluxes(path, &sink->fluxes, sink->network.n_throat);
    regions_free(&sink->regions);
    incidence_free(&sink->incidence);
    network_free(&sink->network);
    free(sink->fluxes.along);
    free(sink);
}

int main(int argc, char **argv)
{
    if (argc != 2 && argc != 2 + RESOLUTIONS && argc != 3 + RESOLUTIONS)
        die(STATUS_USAGE, "usage: laplace PACKING.h5 [CELLS CELLS CELLS [FLUXES.tsv]]");
    const char *fluxes = argc > 2 + RESOLUTIONS ? argv[2 + RESOLUTIONS] : NULL;
    int cells[RESOLUTIONS] = {128, 181, 256};
    for (int r = 0; r < RESOLUTIONS && argc > 2; r++) {
        cells[r] = atoi(argv[2 + r]);
        if (cells[r] < 1 || cells[r] > 800 || (r > 0 && cells[r] <= cells[r - 1]))
            die(STATUS_USAGE, "laplace: CELLS must rise and be from 1 to 800");
    }
    hdf5_begin();
    struct artifact *artifact = artifact_open(argv[1], fluxes ? "network" : NULL);
    struct packing packing = artifact_get_packing(artifact);
    struct sink *sink = fluxes ? sink_of(artifact) : NULL;
    artifact_close(artifact);
    double value[3][RESOLUTIONS];
    for (int r = 0; r < RESOLUTIONS; r++) {
        struct grid grid = grid_of(&packing, cells[r]);
        const bool finest = r == RESOLUTIONS - 1;
        if (sink && finest) sink->regions = regions_of(&grid, &sink->network);
        for (int along = 0; along < 3; along++)
            value[along][r] = diffusivity(&grid, along, finest ? sink : NULL);
        grid_free(&grid);
    }
    print_limits(void_share(&packing), cells, 3, value);
    if (sink) finish(sink, fluxes);
    packing_free(&packing);
    return 0;
}
