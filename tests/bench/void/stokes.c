// SPDX-License-Identifier: GPL-3.0-or-later
// Permeability of a packing in a box that repeats, from Stokes' equations in its void.
//
//     stokes PACKING.h5 [CELLS CELLS CELLS [AXES]]
//
// Unknowns: velocity u_a in the middle of the lower face of each cell across each axis
// a, pressure p in the middle of the cell. For a force of 1 along one axis and a
// viscosity of 1, where the middle of the face is in the void,
//     -laplace(u_a) + (p - p_below) / h = force_a,
// and in each cell with such a face
//     sum over a of (u_a above - u_a) / h = 0.
// In -laplace(u), a neighbour within a sphere is replaced by the wall, u = 0 at a
// distance of theta h along the line, which adds u / (theta h^2): symmetric, second
// order [Gibou, Fedkiw, Cheng & Kang 2002]. Then the mean of u along the force is the
// permeability. Minimal residuals, preconditioned by a multigrid cycle for each u, and
// for p by
//     1 + (D / k) (cycle of -div grad in the void),
// what the pressure feels of viscosity within a pore and of flow between pores [Cahouet
// & Chabard 1988], D / k estimated by Kozeny and Carman.
//
// Prints one line of JSON with the permeability over the square of the mean radius,
// along AXES (x), for each of three CELLS of the cube root of the box's volume (by
// default 80 113 160), its limit and the error of this.
#include "support_extrapolate.h"
#include "support_minres.h"
#include "support_no_slip.h"

#include "artifacts/artifact.h"
#include "basics/memory.h"
#include "basics/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double tolerance = 1e-4; // of the residual; k is then good to 1e-5

struct stokes {
    struct grid grid;
    struct multigrid velocity[3], pressure;
    double between_pores; // D / k
    size_t size;          // of one unknown; in a vector: u along x, y, z, then p
    double volume;        // of a cell
};

// FORCE += grad p, times a cell's volume, where u is. Fills the layer around P.
static void add_gradient(const struct stokes *s, double *p, int a, double *force)
{
    const float *inverse = s->velocity[a].level[0].inverse;
    const size_t next = s->grid.stride[a];
    const double area = s->volume / s->grid.spacing[a];
    fill_around(&s->pressure.level[0], p);
#pragma omp parallel for schedule(static)
    for (size_t c = 0; c < s->size; c++)
        if (inverse[c] > 0) force[c] += area * (p[c] - p[c - next]);
}

// BALANCE += what U brings in across A, where p is. Fills the layer around U.
static void add_inflow(const struct stokes *s, double *u, int a, double *balance)
{
    const float *inverse = s->pressure.level[0].inverse;
    const size_t next = s->grid.stride[a];
    const double area = s->volume / s->grid.spacing[a];
    fill_around(&s->velocity[a].level[0], u);
#pragma omp parallel for schedule(static)
    for (size_t c = 0; c < s->size; c++)
        if (inverse[c] > 0) balance[c] += area * (u[c] - u[c + next]);
}

static void multiply(void *context, const double *x, double *product)
{
    struct stokes *s = context;
    double *p = (double *)x + 3 * s->size; // writes only the layer around
    double *balance = product + 3 * s->size;
    memset(balance, 0, s->size * sizeof *balance);
    for (int a = 0; a < 3; a++) {
        double *u = (double *)x + (size_t)a * s->size;
        double *force = product + (size_t)a * s->size;
        conduct(&s->velocity[a].level[0], u, force);
        add_gradient(s, p, a, force);
        add_inflow(s, u, a, balance);
    }
}

static void precondition(void *context, const double *residual, double *z)
{
    struct stokes *s = context;
    for (int a = 0; a < 3; a++) {
        double *u = z + (size_t)a * s->size;
        multigrid_cycle(&s->velocity[a], residual + (size_t)a * s->size, u);
        // A coarse correction reaches into the solid as well.
        for (size_t c = 0; c < s->size; c++)
            if (!(s->velocity[a].level[0].inverse[c] > 0)) u[c] = 0;
    }
    const double *right = residual + 3 * s->size;
    double *p = z + 3 * s->size;
    multigrid_cycle(&s->pressure, right, p);
    for (size_t c = 0; c < s->size; c++)
        p[c] = s->pressure.level[0].inverse[c] > 0
                   ? s->between_pores * p[c] + right[c] / s->volume
                   : 0;
}

// Faces whose middle is in the void are wide open to the pressure, others are closed.
static void open_to_pressure(struct stokes *s)
{
    for (int a = 0; a < 3; a++) {
        const float *inverse = s->velocity[a].level[0].inverse;
        for (size_t c = 0; c < s->size; c++)
            s->grid.open[a][c] = inverse[c] > 0 ? 1 : 0;
    }
    s->pressure = multigrid_of(&s->grid, -1);
}

static struct stokes stokes_of(const struct packing *packing, int cells, double radius)
{
    struct stokes s = {.grid = grid_of(packing, cells)};
    s.size = s.grid.size;
    s.volume = s.grid.spacing[0] * s.grid.spacing[1] * s.grid.spacing[2];
    for (int a = 0; a < 3; a++)
        s.velocity[a] = multigrid_from(no_slip_level(&s.grid, packing, a));
    open_to_pressure(&s);
    const double share = void_share(packing), size = 2 * radius / s.grid.unit;
    s.between_pores = pow(share, 1.5) * 180 * pow(1 - share, 2) /
                      (share * share * share * size * size);
    return s;
}

static void stokes_free(struct stokes *s)
{
    for (int a = 0; a < 3; a++)
        multigrid_free(&s->velocity[a]);
    multigrid_free(&s->pressure);
    grid_free(&s->grid);
}

// Mean velocity along ALONG for a force of 1.
static double mean_velocity(struct stokes *s, int along)
{
    const int n = (int)(4 * s->size);
    double *force = NEW_ARRAY(double, n), *x = NEW_ARRAY(double, n), left;
    double *pushed = force + (size_t)along * s->size;
    const float *inverse = s->velocity[along].level[0].inverse;
    for (size_t c = 0; c < s->size; c++)
        pushed[c] = inverse[c] > 0 ? s->volume : 0;
    const struct linear_problem problem = {n, s, multiply, precondition, {0}};
    const int steps = minimal_residuals(&problem, force, x, tolerance, 2000, &left);
    if (left > tolerance)
        die(STATUS_NOT_CONVERGED, "stokes: %d iterations were not enough", steps);
    const double mean = sum_of_products(force, x, n);
    fprintf(stderr, "%d cells along %c: %.8g, %d iterations\n", s->grid.n[0],
            "xyz"[along], mean, steps);
    free(force);
    free(x);
    return mean;
}

static double mean_radius(const struct packing *packing)
{
    double sum = 0;
    int n = 0;
    for (int i = 0; i < packing->n_particle; i++)
        if (!is_auxiliary(packing, i)) {
            sum += packing->radius[i];
            n++;
        }
    return sum / n;
}

static void read_cells(int argc, char **argv, int cells[RESOLUTIONS])
{
    for (int r = 0; r < RESOLUTIONS && argc > 2; r++) {
        cells[r] = atoi(argv[2 + r]);
        if (cells[r] < 1 || cells[r] > 500 || (r > 0 && cells[r] <= cells[r - 1]))
            die(STATUS_USAGE, "stokes: CELLS must rise and be from 1 to 500");
    }
}

int main(int argc, char **argv)
{
    if (argc != 2 && argc != 2 + RESOLUTIONS && argc != 3 + RESOLUTIONS)
        die(STATUS_USAGE, "usage: stokes PACKING.h5 [CELLS CELLS CELLS [AXES]]");
    int cells[RESOLUTIONS] = {80, 113, 160};
    read_cells(argc, argv, cells);
    const char *axes = argc > 2 + RESOLUTIONS ? argv[2 + RESOLUTIONS] : "x";
    if (strlen(axes) < 1 || strlen(axes) > 3 || strspn(axes, "xyz") != strlen(axes))
        die(STATUS_USAGE, "stokes: AXES are some of x, y and z");
    hdf5_begin();
    struct artifact *artifact = artifact_open(argv[1], NULL);
    struct packing packing = artifact_get_packing(artifact);
    artifact_close(artifact);
    if (!(packing.periodic[0] && packing.periodic[1] && packing.periodic[2]))
        die(STATUS_BAD_DATA, "stokes: the box must repeat along x, y and z");
    const double radius = mean_radius(&packing);
    double value[3][RESOLUTIONS];
    for (int r = 0; r < RESOLUTIONS; r++) {
        struct stokes s = stokes_of(&packing, cells[r], radius);
        for (int k = 0; axes[k]; k++)
            value[k][r] =
                mean_velocity(&s, axes[k] - 'x') * pow(s.grid.unit / radius, 2);
        stokes_free(&s);
    }
    print_limits(void_share(&packing), cells, (int)strlen(axes), value);
    packing_free(&packing);
    return 0;
}
