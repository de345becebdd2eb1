// SPDX-License-Identifier: GPL-3.0-or-later
// With r = 1, half angle a and contact angle t, the liquid has the area
//     C = cos t (cos t cot a - sin t) + t + a - pi/2.
// Its velocity along the corner, over the pressure gradient and 1 / viscosity, solves
//     w_xx + w_yy = -1,  w = 0 at the walls,  w_n = 0 at the meniscus,
// and beta = C / integral of w. The pressure is that of the gas less gamma / r, so that
// dp/dx = gamma r^-2 dr/dx, and the flow C r^4 / (beta mu) dp/dx is
//     C gamma / (3 beta mu) d(r^3)/dx :
// linear in r^3 (Yiotis et al. 2003).
//
// By symmetry half the liquid is enough. Along the wall, x, it lies below
//     H = x tan a                                  for x up to x_m,
//     H = cos t - sqrt(1 - (cos t cot a - x)^2)    from there up to x_c,
//     x_m = (cos t / sin a - 1) cos a, the bisector's end,   x_c = cos(t + a) / sin a,
// and at H no condition is imposed: on the bisector and the meniscus the derivative
// across vanishes. Bilinear elements between x lines, y = s H, have an error in the
// integral that falls as h^2; two grids and extrapolation leave 1e-5.
#include "corner_film.h"

#include "basics/memory.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>

bool corner_holds_film(double half_angle, double contact_angle)
{
    return contact_angle + half_angle < M_PI / 2;
}

double corner_area(double half_angle, double contact_angle)
{
    const double c = cos(contact_angle), s = sin(contact_angle);
    return c * (c / tan(half_angle) - s) + contact_angle + half_angle - M_PI / 2;
}

// The grid: 2 n columns of n elements, n columns below the bisector and n below the
// meniscus. Nodes at either end and on the wall have w = 0; the others are unknowns, n
// in each inner line.
struct corner_grid {
    int n;
    double *x, *height; // (2 n + 1)
    double *band;       // (unknowns, n + 2) lower triangle: [k][d] couples k and k + d
    double *load;       // (unknowns)
};

static struct corner_grid grid_init(int n, double a, double t)
{
    const size_t unknowns = (size_t)(2 * n - 1) * (size_t)n;
    struct corner_grid grid = {.n = n,
                               .x = NEW_ARRAY(double, 2 * n + 1),
                               .height = NEW_ARRAY(double, 2 * n + 1),
                               .band = NEW_ARRAY(double, unknowns *(size_t)(n + 2)),
                               .load = NEW_ARRAY(double, unknowns)};
    const double middle = (cos(t) / sin(a) - 1) * cos(a), centre = cos(t) / tan(a);
    for (int i = 0; i < n; i++) {
        grid.x[i] = middle * i / n;
        grid.height[i] = grid.x[i] * tan(a);
    }
    // Even steps of the angle around the meniscus' centre.
    for (int i = 0; i <= n; i++) {
        const double angle = (M_PI / 2 - a) + (t - (M_PI / 2 - a)) * i / n;
        grid.x[n + i] = centre - sin(angle);
        grid.height[n + i] = i < n ? cos(t) - cos(angle) : 0;
    }
    return grid;
}

static void grid_free(struct corner_grid *grid)
{
    free(grid->x);
    free(grid->height);
    free(grid->band);
    free(grid->load);
}

// -1: w is 0 there.
static int unknown(const struct corner_grid *grid, int i, int j)
{
    return i == 0 || i == 2 * grid->n || j == 0 ? -1 : (i - 1) * grid->n + j - 1;
}

// One point of integration, (u, v) in the unit square, of an element with its corners
// at X, Y: adds to MATRIX and LOAD.
static void add_point(const double *x, const double *y, double u, double v,
                      double matrix[4][4], double *load)
{
    const double shape[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
    const double du[4] = {v - 1, 1 - v, -v, v}, dv[4] = {u - 1, -u, 1 - u, u};
    double xu = 0, xv = 0, yu = 0, yv = 0;
    for (int k = 0; k < 4; k++) {
        xu += du[k] * x[k];
        xv += dv[k] * x[k];
        yu += du[k] * y[k];
        yv += dv[k] * y[k];
    }
    const double size = xu * yv - xv * yu;
    for (int k = 0; k < 4; k++) {
        load[k] += size / 4 * shape[k];
        for (int l = 0; l < 4; l++) {
            const double px = yv * du[k] - yu * dv[k], py = xu * dv[k] - xv * du[k];
            const double qx = yv * du[l] - yu * dv[l], qy = xu * dv[l] - xv * du[l];
            matrix[k][l] += (px * qx + py * qy) / size / 4;
        }
    }
}

static void add_element(struct corner_grid *grid, int i, int j)
{
    const double *h = grid->height, below = (double)j / grid->n,
                 above = (double)(j + 1) / grid->n;
    const double x[4] = {grid->x[i], grid->x[i + 1], grid->x[i], grid->x[i + 1]};
    const double y[4] = {below * h[i], below * h[i + 1], above * h[i],
                         above * h[i + 1]};
    const int node[4] = {unknown(grid, i, j), unknown(grid, i + 1, j),
                         unknown(grid, i, j + 1), unknown(grid, i + 1, j + 1)};
    double matrix[4][4] = {{0}}, load[4] = {0};
    const double gauss[2] = {0.5 - 0.5 / sqrt(3), 0.5 + 0.5 / sqrt(3)};
    for (int p = 0; p < 4; p++)
        add_point(x, y, gauss[p % 2], gauss[p / 2], matrix, load);
    for (int k = 0; k < 4; k++) {
        if (node[k] < 0) continue;
        grid->load[node[k]] += load[k];
        for (int l = 0; l < 4; l++)
            if (node[l] >= 0 && node[l] <= node[k])
                grid->band[node[l] * (grid->n + 2) + node[k] - node[l]] += matrix[k][l];
    }
}

// The integral, f A^-1 f.
static double flow_by_factor(const struct corner_grid *grid)
{
    const size_t side = (size_t)grid->n, width = side + 2, n = (2 * side - 1) * side;
    gsl_matrix_view band = gsl_matrix_view_array(grid->band, n, width);
    gsl_vector_view load = gsl_vector_view_array(grid->load, n);
    gsl_vector *w = gsl_vector_alloc(n);
    double flow;
    gsl_linalg_cholesky_band_decomp(&band.matrix);
    gsl_linalg_cholesky_band_solve(&band.matrix, &load.vector, w);
    gsl_blas_ddot(&load.vector, w, &flow);
    gsl_vector_free(w);
    return flow;
}

// The integral of w over half the liquid.
static double flow_on_grid(int n, double a, double t)
{
    struct corner_grid grid = grid_init(n, a, t);
    for (int i = 0; i < 2 * n; i++)
        for (int j = 0; j < n; j++)
            add_element(&grid, i, j);
    const double flow = flow_by_factor(&grid);
    grid_free(&grid);
    return flow;
}

double corner_resistance(double half_angle, double contact_angle)
{
    const int n = 24;
    const double coarse = flow_on_grid(n, half_angle, contact_angle);
    const double fine = flow_on_grid(2 * n, half_angle, contact_angle);
    const double flow = 2 * (fine + (fine - coarse) / 3);
    return corner_area(half_angle, contact_angle) / flow;
}

double corner_conductance(double half_angle, double contact_angle)
{
    if (!corner_holds_film(half_angle, contact_angle)) return 0;
    return corner_area(half_angle, contact_angle) /
           (3 * corner_resistance(half_angle, contact_angle));
}
